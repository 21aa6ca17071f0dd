#!/usr/bin/env bash
# Simulates scenes, runs evo-run on them and prints one table: see --help.
set -euo pipefail
# shellcheck source=scripts/bench_common.sh
source "$(dirname "${BASH_SOURCE[0]}")/bench_common.sh"

usage() {
  cat <<'END'
Simulates scenes, runs evo-run on each and prints one table: what the sequence is like, what it cost to make, and how
well it is tracked and followed. The same goes to OUT/scenes.csv, all plots to OUT/report/index.html.

  scripts/bench_scenes.sh [OPTION...] [SCENE[:[FROM+]SECONDS]...]

  scripts/bench_scenes.sh                                       # all scenes of configs/scenes
  scripts/bench_scenes.sh --seeds 1,2,3 driving_night:20 driving_day:50+8
  scripts/bench_scenes.sh --out out/300 --set tracker.features=300 driving_day
  scripts/bench_scenes.sh --simulate-set sensor.threshold_on=0.3 --sequences out/sharp --out out/bench_sharp
  scripts/bench_scenes.sh --simulate-only --seeds 1,2 turns     # only make out/scenes/turns_1_8 and turns_2_8

SCENE is a name in configs/scenes or the path of a scene file, SECONDS is the length of what is simulated and FROM where
in the scene it begins. Without them drives begin at the scene's start and end as --duration says; other scenes last as
long as their file says. Sequences are kept as SEQUENCES/SCENE_SEED_SECONDS, in MVSEC's layout for vehicles and UZH's
for the others, results in OUT under the same name. Called again, the script redoes only what was made from another scene
file, other settings or, of the results, by another build. If a run fails its row says so, and the script ends with 1.

  --seeds LIST             of the worlds and their noise; default 1
  --duration SECONDS       of the drives; default 8
  --set NAME=VALUE         a parameter for `evo-run run`; may be repeated
  --simulate-set NAME=VALUE
                           a parameter for `evo-run simulate`; may be repeated
  --sequences DIR          default out/scenes
  --out DIR                default out/bench_scenes
  --simulate-only          no runs, no table; prints the folders of the sequences
  --anew                   make the sequences anew: needed where the simulator itself has changed
  --delete                 delete the files of each sequence after use: 5 to 20 MB for a second of it

EVO_RUN names the program; without it build/release is brought up to date and used.
END
}

seeds=1
duration=8
run_settings=()
simulate_settings=()
sequences=out/scenes
out=out/bench_scenes
simulate_only=false
anew=false
delete=false
scenes=()
while [ $# -gt 0 ]; do
  case $1 in
    --seeds | --duration | --set | --simulate-set | --sequences | --out)
      [ $# -ge 2 ] || fail "$1 needs a value; see --help"
      ;;&
    --seeds) seeds=$2 && shift ;;
    --duration) duration=$2 && shift ;;
    --set) run_settings+=(--set "$2") && shift ;;
    --simulate-set) simulate_settings+=(--set "$2") && shift ;;
    --sequences) sequences=$2 && shift ;;
    --out) out=$2 && shift ;;
    --simulate-only) simulate_only=true ;;
    --anew) anew=true ;;
    --delete) delete=true ;;
    --help | -h) usage && exit ;;
    -*) fail "there is no option $1; see --help" ;;
    *) scenes+=("$1") ;;
  esac
  shift
done
[ ${#scenes[@]} -gt 0 ] || scenes=("$root"/configs/scenes/*.yaml)

find_program

# How the camera moves and how long, from all parameters of a scene on stdin.
motion_of() {
  awk '/^[a-z]/ { part = $1 }
    part == "motion:" && /^  kind:/ { kind = $2 }
    part == "motion:" && /^  [a-z]+:/ { section = $1 }
    $1 == "duration_s:" && section == kind ":" { seconds = $2 }
    END { print kind, seconds }'
}

# simulate SCENE_FILE SEED [FROM+]SECONDS: sets `name` and makes $sequences/$name unless it is there and made from the
# same. The part may be empty.
simulate() {
  local scene=$1 seed=$2 part=$3 seconds=${3#*+} parameters kind whole format=mvsec from=()
  parameters=$("$EVO_RUN" simulate "$scene" --seed "$seed" "${simulate_settings[@]}" --print)
  read -r kind whole <<<"$(motion_of <<<"$parameters")"
  if [ "$kind" != vehicle ]; then
    format=uzh
    seconds=${seconds:-$whole}
  fi
  seconds=${seconds:-$duration}
  [ "$part" = "$seconds" ] || [ -z "$part" ] || from=(--from "${part%%+*}")
  name=$(basename "$scene" .yaml)_${seed}_${part:-$seconds}
  local folder=$sequences/$name
  local made_from="$parameters"$'\n'"part: ${part:-$seconds}, format: $format"
  if [ "$made_from" = "$(cat "$folder/made_from.txt" 2>/dev/null)" ] && ! $anew; then
    # After --delete only this and the manifest are left, which is enough if the run is there, too.
    [ -n "$(find "$folder" -name '*_data.hdf5' -o -name events.txt)" ] || is_up_to_date && return
  elif [ -n "$(ls -A "$folder" 2>/dev/null)" ] && ! [ -e "$folder/made_from.txt" ]; then
    fail "$folder: was not made by this script and is left alone; choose another folder with --sequences"
  fi
  rm -rf "$folder"
  mkdir -p "$folder"
  : >"$folder/made_from.txt" # filled at the end; tells already now that the folder is ours
  echo "simulate   $folder" >&2
  "$EVO_RUN" simulate "$scene" --seed "$seed" "${simulate_settings[@]}" "${from[@]}" --duration "$seconds" \
    --format "$format" --out "$folder" --quiet >&2
  printf '%s\n' "$made_from" >"$folder/made_from.txt"
}

run_key() {
  printf '%s\n' "$program" "${run_settings[*]}"
  cat "$sequences/$name/made_from.txt"
}

is_up_to_date() {
  ! $simulate_only && [ "$(run_key)" = "$(cat "$out/$name/made_from.txt" 2>/dev/null)" ]
}

# Runs and judges the sequence `name`, unless this is done already.
run() {
  local folder=$sequences/$name results=$out/$name
  is_up_to_date && return
  "$root/scripts/sweep_run.sh" "$results" "$EVO_RUN" run --events "$folder" "${run_settings[@]}" >&2
  if [ -e "$results/tracks.txt" ]; then
    judge_tracks "$results" "$folder"/*_gt.hdf5 "$(calibration_of "$folder")" || true
  fi
  run_key >"$results/made_from.txt"
}

# summary ALIGNMENT COLUMN of the run `name`.
summary() {
  summary_cell "$out/$name/summary.csv" "$1" "$2"
}

header=scene,seed,simulated_s,path_m,events,negative_per_positive,simulate_wall_s,simulate_cpu_s,simulate_peak_memory_mb
header+=,coverage,rebootstraps,mean_planar_percent,max_planar_percent,sim3_mean_planar_percent,sim3_max_planar_percent
header+=,lifetime_frames,lifetime_s,track_error_median_px,expected_feature_age_share,speed_x_real_time,run_cpu_s,failure

# The row of the sequence `name` = SCENE_SEED_[FROM+]SECONDS.
row() {
  local made=$sequences/$name/manifest.json run=$out/$name/manifest.json failure=""
  local part=${name##*_} scene_seed=${name%_*} events positive
  local quality=$out/$name/track_quality/track_quality.csv
  events=$(json "$made" events)
  positive=$(json "$made" positive_events)
  [ ! -e "$out/$name/failure.txt" ] || failure=$(tr ',"' ';'"'" <"$out/$name/failure.txt")
  local cells=(
    "${scene_seed%_*}" "${scene_seed##*_}" "${part#*+}" "$(summary origin-scale path_m)" "$events"
    "$(awk -v n="$events" -v p="$positive" 'BEGIN { if (p > 0) printf "%.4f", (n - p) / p }')"
    "$(json "$made" simulate)" "$(json "$made" cpu_time_s)" "$(json "$made" peak_memory_mb)"
    "$(summary origin-scale coverage)" "$(summary origin-scale rebootstraps)"
    "$(summary origin-scale mean_planar_percent)" "$(summary origin-scale max_planar_percent)"
    "$(summary sim3 mean_planar_percent)" "$(summary sim3 max_planar_percent)"
    "$(quantity "$out/$name/lifetime.csv" mean frames)" "$(quantity "$out/$name/lifetime.csv" mean s)"
    "$(quantity "$quality" track_error_median px 5.000000000)"
    "$(quantity "$quality" expected_feature_age_normalized_1_to_31_px share)"
    "$(awk -v recorded="$(json "$run" recorded_s)" -v track="$(json "$run" track)" -v odometry="$(json "$run" odometry)" \
      'BEGIN { if (track + odometry > 0) printf "%.4f", recorded / (track + odometry) }')"
    "$(json "$run" cpu_time_s)" "$failure"
  )
  local IFS=,
  printf '%s\n' "${cells[*]}"
}

# scenes.csv on stdin as a table to read: rates and costs for each simulated second, shares in %.
print_table() {
  awk -F, '
    function cell(width, format, value) { printf "%" width "s", value == "" ? "-" : sprintf(format, value) }
    function per_second(value) { return value == "" ? "" : value / $3 }
    function percent(value) { return value == "" ? "" : 100 * value }
    NR == 1 {
      print "scene              seed simulated   Mev/s neg:pos    simulate: a second  covered anew" \
            "  planar error, % of path       lifetime     tracks: median   x real     run"
      print "                           s                        s  CPU s      MB       %     " \
            "  mean   max sim3: mean  max  frames     s     px    age %    time CPU s/s"
      next
    }
    {
      printf "%-18s", $1
      cell(5, "%d", $2); cell(10, "%.3g", $3); cell(8, "%.2f", per_second($5) * 1e-6); cell(8, "%.2f", $6)
      cell(9, "%.1f", per_second($7)); cell(7, "%.1f", per_second($8)); cell(8, "%.0f", $9)
      cell(8, "%.1f", percent($10)); cell(5, "%d", $11)
      cell(7, "%.2f", $12); cell(6, "%.2f", $13); cell(11, "%.2f", $14); cell(6, "%.2f", $15)
      cell(7, "%.1f", $16); cell(6, "%.2f", $17); cell(7, "%.2f", $18); cell(7, "%.0f", percent($19))
      cell(9, "%.2f", $20); cell(8, "%.2f", per_second($21))
      print ($22 == "" ? "" : "  " $22)
    }'
}

names=()
for scene in "${scenes[@]}"; do
  seconds=${scene#"${scene%%:*}"}
  file=$(scene_file "$scene")
  for seed in ${seeds//,/ }; do
    simulate "$file" "$seed" "${seconds#:}"
    names+=("$name")
    if $simulate_only; then
      echo "$sequences/$name"
      continue
    fi
    run
    if $delete; then
      find "$sequences/$name" -mindepth 1 ! -name manifest.json ! -name made_from.txt -delete
    fi
  done
done
$simulate_only && exit

{
  echo "$header"
  for name in "${names[@]}"; do row; done
} >"$out/scenes.csv"
"$EVO_RUN" report --force --out "$out/report" --title "Simulated scenes" "${names[@]/#/$out/}" >&2
print_table <"$out/scenes.csv"
awk -F, 'NR > 1 && $NF != "" { failed = 1 } END { exit failed }' "$out/scenes.csv"
