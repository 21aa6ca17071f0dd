# What bench_scenes.sh, bench_tracking.sh and bench_odometry.sh share; to be sourced by them.
# shellcheck shell=bash disable=SC2034,SC2154
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

# check OPTION VALUE PATTERN: refuses a VALUE that is not a list, separated by commas, of what PATTERN matches.
check() {
  [[ $2 =~ ^($3)(,($3))*$ ]] || fail "$1 cannot be '$2'; see --help"
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

# sequence SCENE SEED [OPTION...]: makes a sequence, unless it is there, and prints its folder.
sequence() {
  "$root/scripts/bench_scenes.sh" --sequences "$sequences" "${@:3}" --simulate-only --seeds "$2" "$1"
}

part_pattern='^(.+):(([0-9.]+)\+)?([0-9.]+)$' # FOLDER, FROM and SECONDS are groups 1, 3 and 4

# Refuses `recordings`, each a FOLDER[:[FROM+]SECONDS], that are not there.
check_recordings() {
  local recording
  for recording in "${recordings[@]}"; do
    [ -d "$recording" ] || [[ $recording =~ $part_pattern && -d ${BASH_REMATCH[1]} ]] ||
      fail "there is no folder $recording"
  done
}

# split_recording RECORDING: sets `folder`, its `name`, its `part` with the colon, and `interval`, the options for it.
split_recording() {
  local from=0
  folder=$1
  interval=()
  if [ ! -d "$1" ]; then
    [[ $1 =~ $part_pattern ]]
    folder=${BASH_REMATCH[1]}
    from=${BASH_REMATCH[3]:-0}
    interval=(--from "$from" --to "$(sum "$from" "${BASH_REMATCH[4]}")")
  fi
  part=${1#"$folder"}
  name=$(basename "$folder")
}

# identity FOLDER: what tells a sequence or recording from another one in the same place.
identity() {
  cat "$1/made_from.txt" 2>/dev/null || find -L "$1" -maxdepth 1 -type f -printf '%f %s %T@\n' | sort
}

sum() {
  awk -v a="$1" -v b="$2" 'BEGIN { printf "%.9g\n", a + b }'
}

# ground_truth_of FOLDER: of a sequence or recording, or nothing.
ground_truth_of() {
  local truth
  truth=$(find -L "$1" -maxdepth 1 -name '*_gt.hdf5' | head -n 1)
  echo "${truth:-$(find -L "$1" -maxdepth 1 -name groundtruth.txt)}"
}

# calibration_of FOLDER: of a sequence, or nothing.
calibration_of() {
  find -L "$1" -maxdepth 1 \( -name 'camchain*.yaml' -o -name calib.txt \) | head -n 1
}

# json FILE KEY: the number of that key, which is unique in a manifest.
json() {
  sed -n "s/^ *\"$2\": \([0-9.e+-]*\),*$/\1/p" "$1" 2>/dev/null | head -n 1 || true
}

# quantity FILE NAME UNIT [THRESHOLD]: the value in a table of lifetimes or of track quality, or nothing.
quantity() {
  awk -F, -v name="$2" -v unit="$3" -v threshold="${4:-}" \
    '$1 == name && $2 == unit && $3 == threshold { print $NF; exit }' "$1" 2>/dev/null || true
}

# summary_cell FILE ALIGNMENT COLUMN: a cell of a summary.csv, or nothing.
summary_cell() {
  awk -F, -v alignment="$2" -v column="$3" '
    NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i }
    $2 == alignment { print $at[column] }' "$1" 2>/dev/null || true
}

# failure_of RESULTS: why there are no results, or none that could be judged, for a cell; or nothing.
failure_of() {
  if [ -e "$1/failure.txt" ]; then
    tr ',"' ';'"'" <"$1/failure.txt"
  elif [ -e "$1/judging.txt" ]; then
    tail -n 1 "$1/judging.txt" | tr ',"' ';'"'" | sed 's/^/not judged: /'
  fi
}

# Of numbers in a text. mawk cannot sort.
awk_median='
  function sorted(text, values, n, i, j, value) {
    n = split(text, values, " ")
    for (i = 1; i <= n; ++i) {
      value = values[i] + 0
      for (j = i - 1; j > 0 && values[j] > value; --j) values[j + 1] = values[j]
      values[j + 1] = value
    }
    return n
  }
  function median(text, values, n) {
    n = sorted(text, values)
    return n == 0 ? "" : (values[int((n + 1) / 2)] + values[int(n / 2) + 1]) / 2
  }
  function least(text, values) { return sorted(text, values) == 0 ? "" : values[1] }
  function greatest(text, values, n) {
    n = sorted(text, values)
    return n == 0 ? "" : values[n]
  }
'

# Of a value against a limit, both numbers, the value perhaps missing.
awk_verdict='
  function verdict(value, comparison, limit) {
    if (value == "") return "not measured"
    if (value == limit) return comparison ~ /=/ ? "met" : "missed"
    return (comparison ~ />/) == (value > limit) ? "met" : "missed"
  }
'

describe_machine() {
  printf '\n%s\n' "$threads threads on $(nproc) processors$(sed -n 's/^model name.*:/,/p' /proc/cpuinfo | head -n 1)"
}
