#!/usr/bin/env bash
# Measures how fast and how well evo-run tracks, on simulated scenes and recordings: see --help.
set -euo pipefail
scripts=$(dirname "${BASH_SOURCE[0]}")
# shellcheck source=scripts/bench_common.sh
source "$scripts/bench_common.sh"
# shellcheck source=scripts/bench_tracking_table.sh
source "$scripts/bench_tracking_table.sh"
# shellcheck source=scripts/bench_tracking_scaling.sh
source "$scripts/bench_tracking_scaling.sh"

default_scenes=(driving_day:20+8 driving_night:20+8 bumps:3+8 stop_and_go:14+9 handheld_boxes:4+6)

usage() {
  cat <<END
Measures how fast and how well \`evo-run track\` tracks, with both of its methods, and prints a table: every scene,
seed, method and number of features, then the medians over the seeds, then the targets and whether they are met. The
same goes to OUT/tracking.txt, the numbers with their units to OUT/tracking.csv and OUT/tracking_medians.csv.

  scripts/bench_tracking.sh [OPTION...] [SCENE[:[FROM+]SECONDS]...]

  scripts/bench_tracking.sh                              # all scenes below
  scripts/bench_tracking.sh --seeds 1 --methods em --features 100 driving_day:20+8
  scripts/bench_tracking.sh --set tracker.patch_radius_px=10 --out out/patch_10 driving_day:20+8
  scripts/bench_tracking.sh --recording data_samples/street --recording /data/outdoor_day2:12+60 driving_day:20+8
  scripts/bench_tracking.sh --draw-every 2 --seeds 1 driving_night:20+8         # pictures, see below
  scripts/bench_tracking.sh --scaling                    # time and memory against events, features and length

SCENE, FROM and SECONDS are those of scripts/bench_scenes.sh, which makes the sequences and shares them. Without any:
  ${default_scenes[*]}
Called again, the script redoes only what was made with another build, other settings or another sequence. If a run
fails its row says so, and the script ends with 1.

  --seeds LIST             of the scenes; default 1,2,3
  --methods LIST           default em,klt
  --features LIST          live features to aim at; default 100,300
  --set NAME=VALUE         a parameter for \`evo-run track\`; may be repeated
  --recording FOLDER[:[FROM+]SECONDS]
                           also this recording, in MVSEC's or UZH's layout; may be repeated; without scenes: only
                           these. One without ground truth tells speed and lifetimes
  --repeats N              timed runs of each; default 3
  --threads N              default 2
  --draw-every S           draw the tracks, too, in one more run that is not timed
  --sequences DIR          default out/scenes
  --out DIR                default out/bench_tracking
  --scaling                instead of all that: time and memory, see below
  --long                   with --scaling: memory over 10 minutes, too. Simulating them takes 10 to 30 minutes and
                           300 MB, which are deleted afterwards

Speed. One run at a time. Wall time is that of the stages in the manifest: reading, tracking and writing tracks.txt;
"median" and "best" are over the repeats. CPU time is that of the whole process, its median: on a machine that is busy
with other things it stays about the same while wall time grows. The checksum of the whole events file is computed
beside, which tells where little of a long recording is used.

Tracks. Where there are depth maps, tracks are judged by them. "Error": the median over the tracks of each one's median
error, over its whole life and up to its first error over 5 px. "Age": how long a track stays within 5 px, in % of the
time that its point is visible (a perfect tracker has 100), and in s. "Over 3 px": tracks that ever are; those whose
median error is; of these the ones astray, which follow none of the surfaces within 3 px of where they began either (at
the outline of a thing the point below a feature may be on the other side); and positions from the first such one of a
track on, which is at least the share of positions over 3 px. Tracks on or beside what moves by itself are not judged. Elsewhere, "resid." is the median residual of tracks triangulated with the true poses, a lower bound of the
error. Lifetimes are means.

Pictures. With --draw-every S, OUT/SCENE_SEED_SECONDS/METHOD_FEATURES/drawn/images holds four_frames_SECONDS.png every
S seconds: four consecutive event frames with the live tracks and the way they came, a colour a feature. Compare the
same SECONDS of em_100 and klt_100: does each dot stay on its corner from frame to frame, and is there a corner?

Scaling. On one scene (the first; default ${default_scenes[0]}) and seed (the first), with tables in OUT/scaling_*.csv
and plots of them in OUT/scaling_*.svg:
  events     its first half, with 1, 0.6 and 0.35 of the scene's thresholds: about 1, 2 and 4 times the events
  features   50, 100, 200, 300, 450 and 600 instead of --features, down to 4 px apart, which makes room for them
  length     a quarter, a half and all of it; with --long also 75, 150, 300 and 600 s of a slow drive

EVO_RUN names the program; without it build/release is brought up to date and used.
END
}

seeds=1,2,3
methods=em,klt
features=100,300
settings=()
recordings=()
repeats=3
threads=2
draw_every=""
sequences=out/scenes
out=out/bench_tracking
scaling=false
long=false
scenes=()
while [ $# -gt 0 ]; do
  case $1 in
    --seeds | --methods | --features | --set | --recording | --repeats | --threads | --draw-every | --sequences | --out)
      [ $# -ge 2 ] || fail "$1 needs a value; see --help"
      ;;&
    --seeds) seeds=$2 && shift ;;
    --methods) methods=$2 && shift ;;
    --features) features=$2 && shift ;;
    --set) settings+=(--set "$2") && shift ;;
    --recording) recordings+=("$2") && shift ;;
    --repeats) repeats=$2 && shift ;;
    --threads) threads=$2 && shift ;;
    --draw-every) draw_every=$2 && shift ;;
    --sequences) sequences=$2 && shift ;;
    --out) out=$2 && shift ;;
    --scaling) scaling=true ;;
    --long) long=true ;;
    --help | -h) usage && exit ;;
    -*) fail "there is no option $1; see --help" ;;
    *) scenes+=("$1") ;;
  esac
  shift
done
if [ ${#scenes[@]} -eq 0 ] && [ ${#recordings[@]} -eq 0 ]; then scenes=("${default_scenes[@]}"); fi

check --seeds "$seeds" '[0-9]+'
check --methods "$methods" 'em|klt'
check --features "$features" '[1-9][0-9]*'
[[ $repeats =~ ^[1-9][0-9]*$ ]] || fail "--repeats cannot be '$repeats': a number from 1 on"
[[ $threads =~ ^[1-9][0-9]*$ ]] || fail "--threads cannot be '$threads': a number from 1 on"
$scaling || ! $long || fail "--long goes with --scaling"
! $scaling || [ ${#recordings[@]} -eq 0 ] || fail "--recording does not go with --scaling"
[[ ${settings[*]} != *tracker.@(method|features)=* ]] || fail "--set cannot change these; see --methods and --features"
for scene in "${scenes[@]}"; do scene_file "$scene" >/dev/null; done

check_recordings
find_program

# run_key FOLDER OPTION...: what results depend on.
run_key() {
  printf '%s\n' "$program" "threads $threads, repeats $repeats" "${*:2}"
  identity "$1"
}

# track RESULTS FOLDER METHOD FEATURES [OPTION...]: tracks the recording in FOLDER `repeats` times, unless this is done
# already. RESULTS then holds what the last run left, which is the same for all, and times.csv.
track() {
  local results=$1 folder=$2 made=$1/manifest.json times=run,wall_s,cpu_s,peak_memory_mb run key wall
  local options=("${settings[@]}" --set "tracker.method=$3" --set "tracker.features=$4" "${@:5}")
  key=$(run_key "$folder" "${options[@]}")
  if [ "$key" != "$(cat "$results/made_from.txt" 2>/dev/null)" ]; then
    for ((run = 1; run <= repeats; ++run)); do
      "$root/scripts/sweep_run.sh" "$results" "$EVO_RUN" track --events "$folder" --threads "$threads" --no-plots \
        "${options[@]}" >&2
      [ -e "$made" ] || break
      wall=$(sum "$(json "$made" track)" "$(json "$made" write_tracks)")
      times+=$'\n'"$run,$wall,$(json "$made" cpu_time_s),$(json "$made" peak_memory_mb)"
    done
    printf '%s\n' "$times" >"$results/times.csv"
    if [ -e "$made" ]; then printf '%s\n' "$key" >"$results/made_from.txt"; fi
  fi
  [ -n "$draw_every" ] && [ -e "$made" ] || return 0
  if [ "$draw_every" != "$(cat "$results/drawn/every.txt" 2>/dev/null)" ]; then
    rm -rf "$results/drawn"
    echo "draw       $results/drawn/images" >&2
    "$EVO_RUN" track --events "$folder" --draw-every "$draw_every" "${options[@]}" --out "$results/drawn" --quiet \
      >/dev/null
    echo "$draw_every" >"$results/drawn/every.txt"
  fi
}

# judge RESULTS FOLDER: judges the tracks where there is a truth, unless this is done already. True tracks count only up
# to the last frame: the recording may go on.
judge() {
  local results=$1 truth last
  [ -e "$results/tracks.txt" ] && [ ! -e "$results/track_quality/manifest.json" ] || return 0
  truth=$(ground_truth_of "$2")
  [ -n "$truth" ] || return 0
  last=$(tail -n 1 "$results/tracks.txt" | cut -d ' ' -f 2)
  judge_tracks "$results" "$truth" "$(calibration_of "$2")" --no-plots --to-stamp "$last" 2>"$results/judging.txt" ||
    return 0
  rm "$results/judging.txt"
}

# measure SCENE SEED FOLDER NAME [OPTION...]: all methods and numbers of features, into OUT/NAME; their rows on stdout.
measure() {
  local method count results
  for method in ${methods//,/ }; do
    for count in ${features//,/ }; do
      results=$out/$4/${method}_$count
      track "$results" "$3" "$method" "$count" "${@:5}"
      judge "$results" "$3"
      row "$1" "$2" "$method" "$count" "$results"
    done
  done
}

# measure_recording FOLDER[:[FROM+]SECONDS]
measure_recording() {
  local folder interval name part
  split_recording "$1"
  measure "$name$part" "" "$folder" "recordings/$name${part/:/_}" "${interval[@]}"
}

measure_all() {
  local scene seed folder name
  echo "$header"
  for scene in "${scenes[@]}"; do
    for seed in ${seeds//,/ }; do
      folder=$(sequence "$scene" "$seed")
      name=$(basename "$folder")
      measure "${name%_*_*}:${name##*_}" "$seed" "$folder" "$name"
    done
  done
  for recording in "${recordings[@]}"; do measure_recording "$recording"; done
}

mkdir -p "$out"
if $scaling; then
  measure_scaling "${scenes[0]}" "${seeds%%,*}"
  exit
fi
measure_all >"$out/tracking.csv.part"
mv "$out/tracking.csv.part" "$out/tracking.csv"
medians <"$out/tracking.csv" >"$out/tracking_medians.csv"
{
  print_table <"$out/tracking.csv"
  printf '\n%s\n' "Medians over the seeds"
  print_table <"$out/tracking_medians.csv"
  print_targets <"$out/tracking_medians.csv"
  describe_machine
} | tee "$out/tracking.txt"
awk -F, 'NR > 1 && $NF != "" { failed = 1 } END { exit failed }' "$out/tracking.csv"
