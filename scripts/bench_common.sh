# What bench_scenes.sh and bench_tracking.sh share; to be sourced by them.
# shellcheck shell=bash disable=SC2034
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

fail() {
  echo "$(basename "$0" .sh): error: $1" >&2
  exit 2
}

# Sets EVO_RUN, unless it is given, to the release build, brought up to date, and `program` to what tells builds apart.
find_program() {
  if [ -z "${EVO_RUN:-}" ]; then
    EVO_RUN=$root/build/release/bin/evo-run
    if [ -e "$root/build/release/build.ninja" ]; then
      cmake --build "$root/build/release" --target evo-run >&2
    else
      "$root/scripts/setup.sh" >&2
    fi
  fi
  [ -x "$EVO_RUN" ] || fail "$EVO_RUN is not a program; correct EVO_RUN"
  export EVO_RUN
  program=$(sha256sum <"$EVO_RUN")
}

# scene_file SCENE: its file, from a name in configs/scenes or a path; [:[FROM+]SECONDS] at its end is left out.
scene_file() {
  local file=${1%%:*}
  [ -e "$file" ] || file=$root/configs/scenes/$file.yaml
  [ -e "$file" ] || fail "there is no scene ${1%%:*}; there are $(cd "$root/configs/scenes" && echo *.yaml)"
  echo "$file"
}

# judge_tracks RESULTS TRUTH CALIBRATION [OPTION...]: judges RESULTS/tracks.txt into RESULTS/track_quality.
judge_tracks() {
  local results=$1 truth=$2 calibration=$3
  shift 3
  "$EVO_RUN" evaluate --tracks "$results/tracks.txt" --ground-truth "$truth" --calibration "$calibration" \
    --out "$results/track_quality" --quiet "$@" >/dev/null
}

# calibration_of FOLDER: of a sequence, or nothing.
calibration_of() {
  find -L "$1" -maxdepth 1 \( -name 'camchain*.yaml' -o -name calib.txt \) | head -n 1
}

# json FILE KEY: the number of that key, which is unique in a manifest.
json() {
  sed -n "s/^ *\"$2\": \([0-9.e+-]*\),*$/\1/p" "$1" 2>/dev/null | head -n 1
}

# quantity FILE NAME UNIT [THRESHOLD]: the value in a table of lifetimes or of track quality, or nothing.
quantity() {
  awk -F, -v name="$2" -v unit="$3" -v threshold="${4:-}" \
    '$1 == name && $2 == unit && $3 == threshold { print $NF; exit }' "$1" 2>/dev/null || true
}
