#!/usr/bin/env bash
# Makes the sequences of data_samples again, byte for byte, from the scene files that lie beside them, or compares.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

case "${1:-}" in
  "" | --check) check=${1:-} ;;
  *)
    cat <<'END'
usage: scripts/make_samples.sh [--check]
Simulates the sequences of data_samples anew: half a minute. With --check it leaves them as they are, says which files
would differ and ends with 1 if any does. EVO_RUN names the program; default build/release/bin/evo-run.
END
    [ "$1" = --help ] && exit
    exit 2
    ;;
esac
evo_run=${EVO_RUN:-build/release/bin/evo-run}
[ -x "$evo_run" ] || { echo "$evo_run is missing; build first: scripts/setup.sh, or name it in EVO_RUN" >&2; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
different=0

# sample NAME OPTION...: simulates data_samples/NAME/NAME.yaml.
sample() {
  local name=$1 folder=data_samples/$1 file
  shift
  echo "$evo_run simulate $folder/$name.yaml $*"
  "$evo_run" simulate "$folder/$name.yaml" "$@" --quiet --out "$work/$name" >/dev/null
  # The manifest holds times that differ from run to run; images.txt is empty, since there are no images.
  rm -f "$work/$name/manifest.json" "$work/$name/images.txt"
  if [ -z "$check" ]; then
    cp "$work/$name"/* "$folder"
    return
  fi
  for file in "$work/$name"/*; do
    cmp -s "$file" "$folder/${file##*/}" && continue
    echo "differs: $folder/${file##*/}"
    different=1
  done
}

sample street --from 12 --duration 1.5
sample night --from 12 --duration 1
sample handheld --from 9 --duration 0.6 --format uzh
exit "$different"
