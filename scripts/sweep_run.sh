#!/usr/bin/env bash
# One run of a sweep (see sweep.mk): sweep_run.sh FOLDER COMMAND... calls COMMAND --out FOLDER, with FOLDER emptied first.
# Afterwards that holds `complete`, whose time is that of the start, or, if the command failed, failure.txt, which says
# why. log.txt is the command's stderr. Ends with 0 in both cases, so that the sweep goes on.
set -euo pipefail
folder=$1
shift

# Only what an earlier run of a sweep left is ever deleted: OUT may have been pointed at somebody's recordings.
if [ -n "$(ls -A "$folder" 2>/dev/null)" ] && ! [ -e "$folder/complete" ] && ! [ -e "$folder/failure.txt" ] &&
  ! [ -e "$folder/started" ]; then
  echo "$folder: this folder is not the result of a sweep and is left alone; choose another OUT" >&2
  exit 1
fi
rm -rf "$folder"
mkdir -p "$folder"
touch "$folder/started"
echo "run        $folder"
"$@" --out "$folder" >"$folder/output.txt" 2>"$folder/log.txt" &
run=$!
trap 'kill "$run" 2>/dev/null || true; wait "$run" || true; rm -rf "$folder"; exit 130' INT TERM
code=0
wait "$run" || code=$?
trap - INT TERM

if [ "$code" -eq 0 ]; then
  mv "$folder/started" "$folder/complete"
else
  rm "$folder/started"
  message=$(sed -n 's/^evo-run: error: //p' "$folder/log.txt" | tail -n 1)
  echo "exit code $code: ${message:-no message, see log.txt}" >"$folder/failure.txt"
  echo "failed     $folder: $(cat "$folder/failure.txt")"
fi
