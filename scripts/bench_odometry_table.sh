# The rows, tables and plots of bench_odometry.sh, which sources this.
# shellcheck shell=bash disable=SC2154

header=scene,seed,config,recorded_s,path_m,coverage_share,coverage_since_start_share,rebootstraps,frames_lost
header+=,mean_planar_percent,max_planar_percent,sim3_mean_planar_percent,sim3_max_planar_percent,sim3_ape_rmse_percent
header+=,rotation_deg_per_m,error_before_bump_percent,error_after_bump_percent,bump_growth
header+=,own_scale_error_before_bump_percent,own_scale_error_after_bump_percent,own_scale_bump_growth
header+=,nees_translation,nees_rotation,nees_pose
header+=,run_x_real_time,odometry_x_real_time,cpu_s,failure

# row SCENE SEED CONFIG RESULTS FOLDER
row() {
  local results=$4 made=$4/manifest.json judged=$4 recorded before after own_before own_after
  [ ! -e "$results/judged" ] || judged=$results/judged
  before=$(error_over_5_m "$results/bump/before/metrics.csv" none)
  after=$(error_over_5_m "$results/bump/after/metrics.csv" none)
  own_before=$(error_over_5_m "$results/bump/before/metrics.csv" origin-scale)
  own_after=$(error_over_5_m "$results/bump/after/metrics.csv" origin-scale)
  recorded=$(json "$made" recorded_s)
  if [ -z "$recorded" ] && [ -e "$5/tracks.txt" ]; then recorded=$(duration_of "$5/tracks.txt"); fi
  local cells=(
    "$1" "$2" "$3" "$recorded"
    "$(summary_cell "$judged/summary.csv" origin-scale path_m)"
    "$(summary_cell "$judged/summary.csv" origin-scale coverage)"
    "$(coverage_since_start "$results" "$5")" "$(count_rebootstraps "$made")" "$(json "$made" frames_lost)"
    "$(summary_cell "$judged/summary.csv" origin-scale mean_planar_percent)"
    "$(summary_cell "$judged/summary.csv" origin-scale max_planar_percent)"
    "$(summary_cell "$judged/summary.csv" sim3 mean_planar_percent)"
    "$(summary_cell "$judged/summary.csv" sim3 max_planar_percent)"
    "$(ratio "$(summary_cell "$judged/summary.csv" sim3 ape_rmse_m)" \
      "$(summary_cell "$judged/summary.csv" sim3 path_m)" 100)"
    "$(rotation_drift "$judged/metrics.csv")" "$before" "$after" "$(ratio "$after" "$before")"
    "$own_before" "$own_after" "$(ratio "$own_after" "$own_before")"
    "$(summary_cell "$judged/summary.csv" origin-scale nees_translation)"
    "$(summary_cell "$judged/summary.csv" origin-scale nees_rotation)"
    "$(summary_cell "$judged/summary.csv" origin-scale nees_pose)"
    "$(times_real_time "$recorded" "$(json "$made" track)" "$(json "$made" odometry)")"
    "$(ratio "$recorded" "$(json "$made" odometry)")"
    "$(json "$made" cpu_time_s)" "$(failure_of "$results")"
  )
  local IFS=,
  printf '%s\n' "${cells[*]}"
}

# ratio A B [FACTOR]: or nothing, where one is missing or B is 0.
ratio() {
  awk -v a="$1" -v b="$2" -v factor="${3:-1}" 'BEGIN { if (a != "" && b > 0) printf "%.6f", factor * a / b }'
}

# times_real_time RECORDED TRACK ODOMETRY: or nothing, where nothing was tracked.
times_real_time() {
  [ -z "$2" ] || awk -v recorded="$1" -v spent="$2" -v more="$3" 'BEGIN { printf "%.4f", recorded / (spent + more) }'
}

# duration_of TRACKS: s.
duration_of() {
  awk '!/^#/ {
      t = $2
      if (first == "" || t < first) first = t
      if (t > last) last = t
    }
    END { printf "%.6f", last - first }' "$1"
}

# count_rebootstraps MANIFEST
count_rebootstraps() {
  awk '/"rebootstraps": \[\]/ { print 0; exit }
    /"rebootstraps": \[/ { inside = 1; next }
    inside && /\]/ { print count; exit }
    inside { ++count }' "$1" 2>/dev/null || true
}

# coverage_since_start RESULTS FOLDER: the share, from the first pose to the last tracks, outside stretches of more than
# 0.5 s without a pose, as evaluation.gap_s has it.
coverage_since_start() {
  local tracks=$1/tracks.txt
  [ -e "$1/trajectory.txt" ] || return 0
  [ -e "$tracks" ] || tracks=$2/tracks.txt
  awk '/^#/ { next }
    FILENAME == ARGV[1] {
      if (first == "") first = $1
      else if ($1 - last > 0.5) missing += $1 - last
      last = $1
      next
    }
    $2 > end { end = $2 }
    END {
      if (end - last > 0.5) missing += end - last
      if (end > first) printf "%.6f", 1 - missing / (end - first)
    }' "$1/trajectory.txt" "$tracks"
}

# rotation_drift METRICS: deg/m, mean over the longest sub-trajectories.
rotation_drift() {
  awk -F, '$2 == "origin-scale" && $3 == "subtrajectory" && $4 == "rotation" && $5 == "deg/m" { drift = $11 }
    END { print drift }' "$1" 2>/dev/null || true
}

# error_over_5_m METRICS ALIGNMENT: mean relative error of the translation, in %.
error_over_5_m() {
  awk -F, -v alignment="$2" '$2 == alignment && $3 == "rpe" && $4 == "translation" { printf "%.6f", 20 * $11; exit }' "$1" 2>/dev/null || true
}

# odometry.csv on stdin: for each scene and configuration the median over the seeds and the worst of each quantity.
summarize() {
  awk -F, -v OFS=, -v CONVFMT=%.9g "$awk_median"'
    NR == 1 {
      line = "scene,config,seeds,failures"
      for (i = 4; i < NF; ++i) {
        line = line OFS $i "_median" OFS $i "_worst"
        more_is_better[i] = $i ~ /^coverage|_x_real_time$|^recorded|^path/
      }
      columns = NF
      print line
      next
    }
    {
      group = $1 OFS $3
      if (!seeds[group]++) groups[++count] = group
      if ($NF != "") ++failures[group]
      for (i = 4; i < NF; ++i) if ($i != "") values[group, i] = values[group, i] " " $i
    }
    END {
      for (g = 1; g <= count; ++g) {
        group = groups[g]
        line = group OFS seeds[group] OFS failures[group] + 0
        for (i = 4; i < columns; ++i) {
          text = values[group, i]
          line = line OFS median(text) OFS (more_is_better[i] ? least(text) : greatest(text))
        }
        print line
      }
    }'
}

# odometry_summary.csv on stdin: a table to read for each scene.
print_tables() {
  awk -F, '
    NR == 1 {
      for (i = 1; i <= NF; ++i) at[$i] = i
      next
    }
    {
      scene[++rows] = $1; config[rows] = $2; seeds[rows] = $3; failures[rows] = $4
      for (name in at) value[rows, name] = $at[name]
      if (length($2) > width) width = length($2)
    }
    function number(row, format, name, factor) {
      return value[row, name] == "" ? "-" : sprintf(format, factor * value[row, name])
    }
    function cell(columns, format, name, factor, text) {
      if (factor == "") factor = 1
      text = number(row, format, name "_median", factor)
      if (seeds[row] > 1 && text != "-") text = text " (" number(row, format, name "_worst", factor) ")"
      printf "%" columns "s", text
    }
    END {
      for (row = 1; row <= rows; ++row) {
        if (scene[row] != scene[row - 1]) {
          printf "%s%s, %d %s, %.3g s, %.3g m\n", (row > 1 ? "\n" : ""), scene[row], seeds[row],
            (seeds[row] > 1 ? "seeds: median (worst)" : "run"), value[row, "recorded_s_median"],
            value[row, "path_m_median"]
          printf "%-" width "s%14s%10s%15s%15s%15s%15s%15s%15s%15s%15s%15s%15s\n", "", "covered", "anew", "origin-scale:",
            "largest", "sim3: mean", "largest", "rotation", "over a bump", "its own scale", "errors over", "run, x real",
            "odometry"
          printf "%-" width "s%14s%10s%15s%15s%15s%15s%15s%15s%15s%15s%15s%15s\n", "", "%", "", "mean planar, %",
            "planar, %", "planar, %", "planar, %", "deg/100 m", "growth", "growth", "covariance", "time", "alone"
        }
        printf "%-" width "s", config[row]
        cell(14, "%.1f", "coverage_since_start_share", 100); cell(10, "%d", "rebootstraps")
        cell(15, "%.3g", "mean_planar_percent"); cell(15, "%.3g", "max_planar_percent")
        cell(15, "%.3g", "sim3_mean_planar_percent"); cell(15, "%.3g", "sim3_max_planar_percent")
        cell(15, "%.3g", "rotation_deg_per_m", 100); cell(15, "%.2f", "bump_growth")
        cell(15, "%.2f", "own_scale_bump_growth")
        cell(15, "%.2f", "nees_pose")
        cell(15, "%.1f", "run_x_real_time"); cell(15, "%.1f", "odometry_x_real_time")
        print (failures[row] > 0 ? "  failed: " failures[row] " of " seeds[row] : "")
      }
    }'
}

# What ours is to reach: scene (with or without its part), quantity, median or worst of the seeds, comparison, limit and
# a limit to aim at. 300: with so many features.
targets='
  driving_day:60         mean_planar_percent         median  <=  0.13  0.065
  driving_day:60         max_planar_percent          median  <=  0.4   0.2
  driving_day:60         bump_growth                 median  <=  1.5   -
  driving_day:60         own_scale_bump_growth       median  <=  1.5   -
  driving_day:60         nees_pose                   median  >=  0.5   -
  driving_day:60         nees_pose                   median  <=  2     -
  bumps                  nees_pose                   median  <=  2     -
  driving_night          nees_pose                   median  <=  2     -
  handheld_boxes         nees_pose                   median  <=  2     -
  bumps                  rebootstraps                worst   <=  0     -
  bumps                  frames_lost                 worst   <=  0     -
  bumps                  error_over_that_of_level    median  <=  1.5   -
  driving_night          error_over_that_of_day      median  <=  2     -
  stop_and_go            coverage_since_start_share  worst   >=  0.98  -
  stop_and_go            rebootstraps                worst   <=  0     -
  stop_and_go            mean_planar_percent         median  <=  0.5   -
  turns                  coverage_since_start_share  worst   >=  0.98  -
  turns                  rebootstraps                worst   <=  0     -
  turns                  mean_planar_percent         median  <=  0.5   -
  traffic                coverage_since_start_share  worst   >=  0.98  -
  traffic                rebootstraps                worst   <=  0     -
  traffic                mean_planar_percent         median  <=  0.5   -
  highway                coverage_since_start_share  worst   >=  0.98  -
  highway                rebootstraps                worst   <=  0     -
  highway                mean_planar_percent         median  <=  0.5   -
  handheld_boxes         coverage_since_start_share  worst   >=  0.98  -
  handheld_boxes         rebootstraps                worst   <=  0     -
  handheld_boxes         sim3_mean_planar_percent    median  <=  0.5   -
  slider                 coverage_since_start_share  worst   >=  0.98  -
  slider                 rebootstraps                worst   <=  0     -
  slider                 mean_planar_percent         median  <=  0.5   -
  uzh_boxes_6dof_tracks  sim3_ape_rmse_percent       median  <=  0.7   -
  street_12s             mean_planar_percent         median  <=  0.2   -
  street_12s             max_planar_percent          median  <=  0.5   -
  driving_day            odometry_x_real_time        median  >=  10    -
  driving_day            run_x_real_time             median  >=  2.5   -  300'

# print_targets CONFIG CONFIG_300: odometry_summary.csv on stdin beside the targets of its scenes.
print_targets() {
  awk -F, -v targets="${targets//$'\n'/;}" -v ours="$1" -v ours_300="$2" "$awk_verdict"'
    function name_of(scene) { return substr(scene, 1, index(scene ":", ":") - 1) }
    function error_over(scene, config, other, all, one) {
      all = value[other substr(scene, index(scene ":", ":")), config, "mean_planar_percent_median"]
      one = value[scene, config, "mean_planar_percent_median"]
      return one != "" && all > 0 ? one / all : ""
    }
    NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; next }
    {
      for (name in at) value[$1, $2, name] = $at[name]
      if ($1 != scenes[rows]) scenes[++rows] = $1
    }
    END {
      n = split(targets, lines, ";")
      for (row = 1; row <= rows; ++row) {
        scene = scenes[row]
        for (line = 1; line <= n; ++line) {
          if (split(lines[line], target, " ") == 0 || (target[1] != scene && target[1] != name_of(scene))) continue
          if (!printed++) {
            printf "\n%-24s%-28s%-7s%11s%9s%10s\n", "Targets of " ours, "", "seeds", "target", "stretch", "measured"
          }
          config = split(lines[line], target, " ") > 6 ? ours_300 : ours
          if (target[2] == "error_over_that_of_day") reached = error_over(scene, config, "driving_day")
          else if (target[2] == "error_over_that_of_level") reached = error_over(scene, config, "bumps_level")
          else reached = value[scene, config, target[2] "_" target[3]]
          result = verdict(reached, target[4], target[5] + 0)
          if (result == "met" && target[6] != "-" && verdict(reached, target[4], target[6] + 0) == "met") {
            result = "met, stretch too"
          }
          failures = value[scene, config, "failures"]
          if (failures > 0) result = "missed: " failures " of " value[scene, config, "seeds"] " failed"
          printf "%-24s%-28s%-7s%5s%6s%9s%10s  %s%s\n", scene, target[2], target[3], target[4], target[5], target[6],
            reached == "" ? "-" : sprintf("%.3g", reached), result, config == ours ? "" : ", " config
        }
      }
    }'
}

# draw NAME: OUT/NAME.gnuplot, where there is gnuplot. No table is given up for a plot.
draw() {
  if command -v gnuplot >/dev/null; then
    (cd "$out" && gnuplot "$1.gnuplot") || echo "$out/$1.gnuplot could not be drawn" >&2
  else
    echo "gnuplot is not installed: $out/$1.gnuplot is left for later" >&2
  fi
}

# plot_errors TABLE: the mean planar error of every scene, a bar for each configuration, into OUT/TABLE_error.svg.
plot_errors() {
  local name=${1}_error scenes
  awk -F, '
    NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; next }
    {
      if (!seen_scene[$1]++) scenes[++rows] = $1
      if (!seen_config[$2]++) configs[++columns] = $2
      error[$1, $2] = $at["mean_planar_percent_median"]
    }
    END {
      printf "scene"
      for (c = 1; c <= columns; ++c) printf ",%s", configs[c]
      print ""
      for (r = 1; r <= rows; ++r) {
        printf "%s", scenes[r]
        for (c = 1; c <= columns; ++c) {
          value = error[scenes[r], configs[c]]
          printf ",%s", value == "" ? "?" : value
        }
        print ""
      }
    }' "$out/$1_summary.csv" >"$out/$name.dat"
  scenes=$(($(wc -l <"$out/$name.dat") - 1))
  cat >"$out/$name.gnuplot" <<END
set terminal svg size $((360 + scenes * (40 + 20 * ${#labels[@]}))),450 noenhanced background "white"
set output "$name.svg"
set datafile separator ","
set datafile missing "?"
set style data histogram
set style histogram clustered gap 1
set style fill solid 0.8
set logscale y
set yrange [0.01:*]
set grid ytics
set xtics rotate by -30
set rmargin 15
set key outside top horizontal
set ylabel "mean planar error, % of the path"
plot for [i=2:$((${#labels[@]} + 1))] "$name.dat" using i:xtic(1) title columnheader(i)
END
  if grep -q ',[0-9]' "$out/$name.dat"; then draw "$name"; fi
}

# plot_drift TABLE NAME: the planar error of OUT/NAME over the distance, a line for each configuration, into
# OUT/TABLE_drift.svg.
plot_drift() {
  local name=${1}_drift label file lines=()
  for label in "${labels[@]}"; do
    for file in "$out/$2/${label//[ \/]/_}"/{,judged/}errors.csv; do
      [ ! -e "$file" ] || lines+=("\"${file#"$out/"}\" using 2:6 with lines title \"$label\"")
    done
  done
  [ ${#lines[@]} -gt 0 ] || return 0
  {
    cat <<END
set terminal svg size 800,450 noenhanced background "white"
set output "$name.svg"
set datafile separator ","
set title "$2"
set logscale y
set grid
set key outside top horizontal
set xlabel "distance, m"
set ylabel "planar error, origin-scale, m"
END
    printf 'plot %s' "${lines[0]}"
    [ ${#lines[@]} -eq 1 ] || printf ', \\\n  %s' "${lines[@]:1}"
    echo
  } >"$out/$name.gnuplot"
  draw "$name"
}
