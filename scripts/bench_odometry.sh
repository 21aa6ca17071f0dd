#!/usr/bin/env bash
# Measures how well and how fast evo-run follows the camera, on simulated scenes and recordings: see --help.
set -euo pipefail
scripts=$(dirname "${BASH_SOURCE[0]}")
# shellcheck source=scripts/bench_common.sh
source "$scripts/bench_common.sh"
# shellcheck source=scripts/bench_odometry_table.sh
source "$scripts/bench_odometry_table.sh"

default_scenes=(driving_day:60 driving_day:20+8 driving_night:20+8 bumps:3+8 stop_and_go:14+9 turns:2+8 traffic:6
  highway:4+6 handheld_boxes:4+6 slider)
ablation_scenes=(driving_day:60 bumps:3+8 driving_night:20+8)
with_more_features=tracker.features=300
# Each switches one ingredient off.
ablations=(
  odometry.ground.hold_height=false
  odometry.final.motion=0
  odometry.final.drift=0
  odometry.final.own_noise=false
  odometry.final_refinement=false
  odometry.window_refinement=false
  odometry.bootstrap.refine=false
  odometry.key_frame.every_frames=5
  odometry.depth_filter.old_key_frames=0
  odometry.max_outliers=1000
  tracker.ego_motion=false
  tracker.epipolar_filter=false
  tracker.window_bend_px=1000
  tracker.follow_jolts=false
  tracker.restore_shake=false
  tracker.uninformative_share=0
  tracker.odd_share=0
  tracker.template_gain=1
  tracker.use_polarity=false
)

usage() {
  cat <<END
Measures how well and how fast \`evo-run run\` follows the camera and prints a table for each scene, a row for each
configuration, medians over the seeds and in parentheses the worst of them; then the targets and whether they are met.
The same goes to OUT/odometry.txt, all numbers to OUT/odometry.csv (a row a scene, seed and configuration) and
OUT/odometry_summary.csv (medians and worst), plots of them to OUT/odometry_*.svg.

  scripts/bench_odometry.sh [OPTION...] [SCENE[:[FROM+]SECONDS]...]

  scripts/bench_odometry.sh                                     # all scenes below; ours, the paper's, 300 features
  scripts/bench_odometry.sh --seeds 1 turns:2+8 bumps:3+8
  scripts/bench_odometry.sh --seeds 1,2,3,4,5,6,7,8,9,10 --config ours driving_day:60
  scripts/bench_odometry.sh --set odometry.window=12 --set "odometry.window=12 odometry.loss_px=2" driving_day:60
  scripts/bench_odometry.sh --recording /data/street_12s --recording /data/uzh_boxes_6dof_tracks
  scripts/bench_odometry.sh --ablation                          # one ingredient switched off at a time

SCENE, FROM and SECONDS are those of scripts/bench_scenes.sh, which makes the sequences and shares them. Without any:
  ${default_scenes[*]}
Called again, the script redoes only what was made with another build, other parameters or another sequence. If a run
fails its row says so, and the script ends with 1.

  --seeds LIST             of the scenes; default 1,2,3
  --config NAME            a configuration: \`ours\`, the program's defaults; the name of a file in configs, such as
                           \`paper\`; or a file. May be repeated; default: ours and paper, and ours with 300 features;
                           with --set or --ablation: ours
  --set "NAME=VALUE..."    another configuration: ours but for these parameters, between blanks; may be repeated
  --recording FOLDER[:[FROM+]SECONDS]
                           also this recording, in MVSEC's or UZH's layout, or a folder of given tracks: tracks.txt,
                           calib.txt or camchain*.yaml, and the ground truth; may be repeated; without scenes: only these
  --ablation               all of the ingredients below instead of the default configurations, on these scenes unless
                           others are named: ${ablation_scenes[*]}.
                           Tables are then OUT/ablation*. The final refinement mends much of what goes before
                           it: --set "odometry.final_refinement=false NAME=VALUE" shows an ingredient without it
  --threads N              default 2
  --sequences DIR          default out/scenes
  --out DIR                default out/bench_odometry

Errors are in % of the path; "origin-scale" lays the first pose on the true one and takes one scale, "sim3" fits
everything (it is left out where a straight line does not determine it), "rotation" is the drift over half of the path.
"Errors over covariance" are the squared errors of the poses over what pose_covariance.csv says, for one degree of
freedom: 1 on average if it is honest.
"Covered" is the share of the time since the first pose that has poses, "anew" how often the map was started anew.
Real-time factors are for one run, one at a time: of tracking and odometry together, and of the odometry alone.

Bumps. Where a scene has 5 s before and after the start of its first bump, the growth is the mean error over 5 m (of all
pairs of poses so far apart) in the 5 s after it over that in the 5 s before: in the scale of the whole run, where slow
drift of the scale counts, too, and with a scale for each 5 s. The scene \`bumps\` has a bump every 5 s and is compared
with \`bumps_level\`, the same without any, which is made beside it.

Ingredients of --ablation:
$(printf '  %s\n' "${ablations[@]}")

EVO_RUN names the program; without it build/release is brought up to date and used.
END
}

seeds=1,2,3
configs=()
variants=()
recordings=()
ablation=false
threads=2
sequences=out/scenes
out=out/bench_odometry
scenes=()
while [ $# -gt 0 ]; do
  case $1 in
    --seeds | --config | --set | --recording | --threads | --sequences | --out)
      [ $# -ge 2 ] || fail "$1 needs a value; see --help"
      ;;&
    --seeds) seeds=$2 && shift ;;
    --config) configs+=("$2") && shift ;;
    --set) variants+=("$2") && shift ;;
    --recording) recordings+=("$2") && shift ;;
    --ablation) ablation=true ;;
    --threads) threads=$2 && shift ;;
    --sequences) sequences=$2 && shift ;;
    --out) out=$2 && shift ;;
    --help | -h) usage && exit ;;
    -*) fail "there is no option $1; see --help" ;;
    *) scenes+=("$1") ;;
  esac
  shift
done
check --seeds "$seeds" '[0-9]+'
[[ $threads =~ ^[1-9][0-9]*$ ]] || fail "--threads cannot be '$threads': a number from 1 on"
table=odometry
if $ablation; then
  table=ablation
  variants=("${ablations[@]}" "${variants[@]}")
fi
if [ ${#scenes[@]} -eq 0 ] && [ ${#recordings[@]} -eq 0 ]; then
  if $ablation; then scenes=("${ablation_scenes[@]}"); else scenes=("${default_scenes[@]}"); fi
fi
if [ ${#configs[@]} -eq 0 ]; then
  configs=(ours)
  [ ${#variants[@]} -gt 0 ] || configs+=(paper) variants=("$with_more_features")
fi
for scene in "${scenes[@]}"; do scene_file "$scene" >/dev/null; done
check_recordings

# The configurations by their names in the tables: what `evo-run` is called with.
labels=()
declare -A file_of
for config in "${configs[@]}"; do
  label=$(basename "$config" .yaml)
  file=""
  if [ "$config" != ours ]; then
    file=$config
    [ -f "$file" ] || file=$root/configs/$config.yaml
    [ -f "$file" ] || fail "--config: there is no configuration $config, here or in $root/configs"
  fi
  [ -z "${file_of[$label]+given}" ] || fail "--config: there are two configurations with the name $label"
  file_of[$label]=$file
  labels+=("$label")
done
for variant in "${variants[@]}"; do
  [[ $variant =~ ^[^=\ ,]+=[^\ ,]*(\ +[^=\ ,]+=[^\ ,]*)*$ ]] ||
    fail "--set cannot be '$variant': NAME=VALUE, or several with blanks between them, without commas"
  labels+=("$variant")
done

# Sets `options` to those of a configuration.
options_of() {
  local setting
  options=()
  if [ -n "${file_of[$1]+given}" ]; then
    [ -z "${file_of[$1]}" ] || options=(--config "${file_of[$1]}")
    return
  fi
  for setting in $1; do options+=(--set "$setting"); done
}

# A parameter that does not exist is told before anything is done.
find_program
for label in "${labels[@]}"; do
  options_of "$label"
  message=$("$EVO_RUN" config --print "${options[@]}" 2>&1 >/dev/null) || fail "$label: ${message#evo-run: error: }"
done

# run_key FOLDER LABEL OPTION...: what results depend on.
run_key() {
  printf '%s\n' "$program" "threads $threads" "${*:3}"
  [ -z "${file_of[$2]:-}" ] || cat "${file_of[$2]}"
  identity "$1"
}

# follow RESULTS FOLDER LABEL [OPTION...]: runs on the recording, or the tracks, in FOLDER, unless this is done already.
follow() {
  local results=$1 folder=$2 key options command
  options_of "$3"
  options+=("${@:4}")
  key=$(run_key "$folder" "$3" "${options[@]}")
  [ "$key" != "$(cat "$results/made_from.txt" 2>/dev/null)" ] || return 0
  if holds_tracks "$folder"; then
    command=(odometry --tracks "$folder/tracks.txt" --calibration "$(calibration_of "$folder")")
  else
    command=(run --events "$folder" --no-plots)
  fi
  "$root/scripts/sweep_run.sh" "$results" "$EVO_RUN" "${command[@]}" --threads "$threads" "${options[@]}" >&2
  [ -e "$results/complete" ] || return 0
  if holds_tracks "$folder"; then judge_trajectory "$results" "$folder"; fi
  printf '%s\n' "$key" >"$results/made_from.txt"
}

holds_tracks() {
  [ -e "$1/tracks.txt" ] && [ -z "$(find -L "$1" -maxdepth 1 \( -name '*_data.hdf5' -o -name events.txt \))" ]
}

# judge_trajectory RESULTS FOLDER: against the truth beside the given tracks, if there is one. Ends with 7 where a
# straight line does not determine sim3.
judge_trajectory() {
  local truth alignments code covariances=()
  truth=$(ground_truth_of "$2")
  [ -n "$truth" ] || return 0
  [ ! -e "$1/pose_covariance.csv" ] || covariances=(--covariances "$1/pose_covariance.csv")
  for alignments in origin-scale,sim3 origin-scale; do
    code=0
    "$EVO_RUN" evaluate --estimate "$1/trajectory.txt" "${covariances[@]}" --ground-truth "$truth" \
      --align "$alignments" --out "$1/judged" --no-plots --quiet >/dev/null 2>"$1/judging.txt" || code=$?
    [ "$code" -eq 7 ] || break
  done
  if [ "$code" -eq 0 ]; then rm "$1/judging.txt"; fi
}

# judge_bump RESULTS FOLDER STAMP: the relative errors in the 5 s before and after STAMP, in the scale of the whole run.
judge_bump() {
  local results=$1 scale part from
  [ -n "$3" ] && [ -e "$results/complete" ] && [ ! -e "$results/bump" ] || return 0
  scale=$(summary_cell "$results/summary.csv" origin-scale scale)
  [ -n "$scale" ] || return 0
  mkdir "$results/bump"
  awk -v scale="$scale" '!/^#/ { for (i = 2; i <= 4; ++i) $i = sprintf("%.9f", scale * $i); print }' \
    "$results/trajectory.txt" >"$results/bump/trajectory.txt"
  for part in before after; do
    from=$3
    [ $part = after ] || from=$(stamp "$3" -5)
    "$EVO_RUN" evaluate --estimate "$results/bump/trajectory.txt" --ground-truth "$(ground_truth_of "$2")" \
      --align none,origin-scale --rpe 5m --rpe-pairs all --set evaluation.rpe_pairs_from=truth --from-stamp "$from" \
      --to-stamp "$(stamp "$from" 5)" --out "$results/bump/$part" --no-plots --quiet >/dev/null \
      2>"$results/bump/$part.txt" || true
  done
}

stamp() {
  awk -v a="$1" -v b="$2" 'BEGIN { printf "%.9f\n", a + b }'
}

# bump_of SCENE FOLDER: the stamp of the scene's first bump if the sequence has 5 s before and after it, or nothing.
bump_of() {
  local first part=${2##*_} from=0
  first=$("$EVO_RUN" simulate "$(scene_file "$1")" --print | sed -n 's/^ *bumps_at_s: "\{0,1\}\([0-9.]\{1,\}\).*/\1/p')
  [ -n "$first" ] || return 0
  [[ $part != *+* ]] || from=${part%%+*}
  awk -v first="$first" -v from="$from" -v seconds="${part#*+}" -v start="$(json "$2/manifest.json" start_s)" 'BEGIN {
    if (first - 5 >= from && first + 5 <= from + seconds) printf "%.9f\n", start + first - from
  }'
}

# measure SCENE SEED FOLDER NAME BUMP [OPTION...]: all configurations, into OUT/NAME; their rows on stdout.
measure() {
  local label results
  first_results=${first_results:-$4}
  for label in "${labels[@]}"; do
    results=$out/$4/${label//[ \/]/_}
    follow "$results" "$3" "$label" "${@:6}"
    judge_bump "$results" "$3" "$5"
    row "$1" "$2" "$label" "$results" "$3"
  done
}

# measure_scene SCENE SEED
measure_scene() {
  local folder name
  folder=$(sequence "$1" "$2")
  name=$(basename "$folder")
  measure "${name%_*_*}:${name##*_}" "$2" "$folder" "$name" "$(bump_of "$1" "$folder")"
  [ "${name%_*_*}" = bumps ] && ! $ablation || return 0
  folder=$(sequence "$1" "$2" --sequences "$sequences/level" --simulate-set motion.vehicle.bumps_at_s=)
  measure "bumps_level:${name##*_}" "$2" "$folder" "level/$name" ""
}

# measure_recording FOLDER[:[FROM+]SECONDS]
measure_recording() {
  local folder interval name part
  split_recording "$1"
  measure "$name$part" "" "$folder" "recordings/$name${part/:/_}" "" "${interval[@]}"
}

measure_all() {
  local scene seed recording
  echo "$header"
  for scene in "${scenes[@]}"; do
    for seed in ${seeds//,/ }; do measure_scene "$scene" "$seed"; done
  done
  for recording in "${recordings[@]}"; do measure_recording "$recording"; done
}

for recording in "${recordings[@]}"; do
  split_recording "$recording"
  [ -z "$part" ] || ! holds_tracks "$folder" || fail "$recording: of given tracks, no part can be taken"
done

mkdir -p "$out"
first_results=""
measure_all >"$out/$table.csv.part"
mv "$out/$table.csv.part" "$out/$table.csv"
summarize <"$out/$table.csv" >"$out/${table}_summary.csv"
{
  print_tables <"$out/${table}_summary.csv"
  $ablation || print_targets "${labels[0]}" "$with_more_features" <"$out/${table}_summary.csv"
  describe_machine
} | tee "$out/$table.txt"
plot_errors "$table"
plot_drift "$table" "$first_results"
awk -F, 'NR > 1 && $NF != "" { failed = 1 } END { exit failed }' "$out/$table.csv"
