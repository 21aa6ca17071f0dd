# How time and memory of the tracker grow: bench_tracking.sh --scaling, which sources this.
# shellcheck shell=bash disable=SC2154

# measure_scaling SCENE[:[FROM+]SECONDS] SEED
measure_scaling() {
  local folder part seconds share
  folder=$(sequence "$1" "$2")
  part=${folder##*_}
  seconds=${part#*+}
  scaling_rows_of_events "${1%%:*}:${part%"$seconds"}$(product "$seconds" 0.5)" "$2" | keep_rows events
  scaling_rows features "$folder" "$seconds" 50,100,200,300,450,600 --set tracker.corner_spacing_px=4 |
    keep_rows features
  {
    for share in 0.25 0.5 1; do
      scaling_rows length "$folder" "$(product "$seconds" "$share")" "$features"
    done
    ! $long || scaling_rows_of_slow_drive "$2"
  } | keep_rows length

  {
    echo "Time against events"
    print_scaling <"$out/scaling_events.csv"
    printf '\n%s\n' "Time against features"
    print_scaling <"$out/scaling_features.csv"
    printf '\n%s\n' "Memory against length"
    print_scaling <"$out/scaling_length.csv"
    describe_machine
  } | tee "$out/scaling.txt"
  plot_scaling events events_per_s 1e-6 "million events a second" wall_s_per_recorded_s cpu_s_per_recorded_s
  plot_scaling features mean_live_features 1 "live features" wall_s_per_recorded_s cpu_s_per_recorded_s
  plot_scaling length recorded_s 1 "recorded s" peak_memory_mb
  awk -F, 'FNR > 1 && $NF != "" { failed = 1 } END { exit failed }' "$out"/scaling_*.csv
}

product() {
  awk -v a="$1" -v b="$2" 'BEGIN { printf "%.9g\n", a * b }'
}

# scaling_rows WHAT FOLDER SECONDS FEATURES [OPTION...]: a row for each method and number of features in that list, over
# the first SECONDS of the sequence in FOLDER.
scaling_rows() {
  local name=${2#"$sequences"/} method count results
  for method in ${methods//,/ }; do
    for count in ${4//,/ }; do
      results=$out/scaling/$1/$name/${method}_${count}_$3
      track "$results" "$2" "$method" "$count" --to "$3" "${@:5}"
      echo "$name,$method,$count,$threads,$repeats,$(speed_cells "$results"),$(failure_of "$results")"
    done
  done
}

# scaling_rows_of_events SCENE:[FROM+]SECONDS SEED: with the scene's thresholds and with lower ones.
scaling_rows_of_events() {
  local folder share name lowered
  folder=$(sequence "$1" "$2")
  scaling_rows events "$folder" "${1##*[:+]}" "$features"
  for share in 0.6 0.35; do # about 2 and 4 times the events
    lowered=()
    for name in threshold_on threshold_off threshold_spread; do
      lowered+=(--simulate-set "sensor.$name=$(product "$(scene_parameter "$1" "$name")" "$share")")
    done
    folder=$(sequence "$1" "$2" --sequences "$sequences/thresholds_$share" "${lowered[@]}")
    scaling_rows events "$folder" "${1##*[:+]}" "$features"
  done
}

# scene_parameter SCENE NAME: its value there.
scene_parameter() {
  "$EVO_RUN" simulate "$(scene_file "$1")" --print | sed -n "s/^ *$2: \([0-9.e+-]*\).*/\1/p"
}

# scaling_rows_of_slow_drive SEED: over 10 minutes of few events, which need little disk. The sequence is deleted at the
# end, but for what tells that the results are still its own.
scaling_rows_of_slow_drive() {
  local folder=$sequences/slow/driving_day_${1}_600 done=$out/scaling/length/slow.txt repeats=1 setting seconds key
  local with=() simulate_with=()
  for setting in scene.calibration=davis240c motion.vehicle.speed_m_s=1 motion.vehicle.duration_s=600 \
    sensor.threshold_on=0.35 sensor.threshold_off=0.12 simulation.samples=1 simulation.longest_step_s=0.01 \
    simulation.image_hz=0 simulation.depth_hz=0 output.pose_hz=20; do
    with+=(--set "$setting")
    simulate_with+=(--simulate-set "$setting")
  done
  key="$program $1 $threads $methods ${features%%,*} ${settings[*]}
$("$EVO_RUN" simulate "$(scene_file driving_day)" --seed "$1" "${with[@]}" --print)"
  if [ ! -e "$folder/made_from.txt" ] || [ "$key" != "$(cat "$done" 2>/dev/null)" ]; then
    sequence driving_day:600 "$1" --sequences "$sequences/slow" "${simulate_with[@]}" >/dev/null
  fi
  for seconds in 75 150 300 600; do scaling_rows length "$folder" "$seconds" "${features%%,*}"; done
  echo "$key" >"$done"
  find "$folder" -mindepth 1 ! -name manifest.json ! -name made_from.txt -delete
}

# keep_rows NAME: puts the rows on stdin into OUT/scaling_NAME.csv.
keep_rows() {
  {
    echo "sequence,method,features,threads,repeats,$speed_header,failure"
    cat
  } >"$out/scaling_$1.csv"
}

# One of the tables on stdin to read.
print_scaling() {
  awk -F, '
    NR == 1 {
      for (i = 1; i <= NF; ++i) at[$i] = i
      printf "%-40s method  live features  recorded    rate  wall s   CPU s  peak memory\n", "sequence"
      printf "%40s         asked   mean         s   Mev/s  a recorded s           MB\n", ""
      next
    }
    $at["recorded_s"] == "" {
      printf "%-40s %-6s%8d  %s\n", $1, $2, $3, $NF
      next
    }
    {
      printf "%-40s %-6s%8d%7.1f%10.1f", $1, $2, $3, $at["mean_live_features"], $at["recorded_s"]
      printf "%8.3f%8.3f%8.3f%13.1f\n", 1e-6 * $at["events_per_s"], $at["wall_s_per_recorded_s"],
        $at["cpu_s_per_recorded_s"], $at["peak_memory_mb"]
    }'
}

# plot_scaling NAME X FACTOR LABEL Y...: draws OUT/scaling_NAME.csv, a panel for each column Y against column X times
# FACTOR, a line for each method and, unless that is what is varied, number of features, the slow drive apart.
plot_scaling() {
  local file=$out/scaling_$1 last y columns
  columns="$2 ${*:5}"
  awk -F, -v columns="$columns" -v factor="$3" -v by_features="$([ "$1" = features ] || echo 1)" '
    NR == 1 {
      for (i = 1; i <= NF; ++i) at[$i] = i
      n = split(columns, names, " ")
      next
    }
    $at[names[1]] != "" {
      line = ($1 ~ /^slow/ ? "slow drive, " : "") $2 (by_features ? ", " $3 " features" : "")
      if (!(line in points)) lines[++count] = line
      points[line] = points[line] factor * $at[names[1]]
      for (i = 2; i <= n; ++i) points[line] = points[line] " " $at[names[i]]
      points[line] = points[line] "\n"
    }
    END { for (i = 1; i <= count; ++i) printf "\"%s\"\n%s\n\n", lines[i], points[lines[i]] }' "$file.csv" >"$file.dat"
  last=$(($(grep -c '^"' "$file.dat" || true) - 1))
  {
    cat <<END
set terminal svg size $((($# - 4) * 500)),400 background "white"
set output "scaling_$1.svg"
set multiplot layout 1,$(($# - 4))
set xlabel "$4"
set xrange [0:*]
set yrange [0:*]
set grid
set key bottom right
END
    for ((y = 5; y <= $#; ++y)); do
      echo "set ylabel \"$(label_of "${!y}")\""
      echo "plot for [i=0:$last] \"scaling_$1.dat\" index i using 1:$((y - 3)) with linespoints title columnheader(1)"
    done
  } >"$file.gnuplot"
  if command -v gnuplot >/dev/null; then
    (cd "$out" && gnuplot "scaling_$1.gnuplot")
  else
    echo "gnuplot is not installed: $file.gnuplot is left for later" >&2
  fi
}

label_of() {
  case $1 in
    wall_s_per_recorded_s) echo "wall time, s a recorded s" ;;
    cpu_s_per_recorded_s) echo "CPU time, s a recorded s" ;;
    peak_memory_mb) echo "peak memory, MB" ;;
  esac
}
