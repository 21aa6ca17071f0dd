# The rows and tables of bench_tracking.sh, which sources this.
# shellcheck shell=bash disable=SC2154

speed_header=recorded_s,events_per_s,mean_live_features,real_time_factor_median,real_time_factor_best
speed_header+=,wall_s_per_recorded_s,cpu_s_per_recorded_s,peak_memory_mb

# speed_cells RESULTS: the cells of speed_header.
speed_cells() {
  local made=$1/manifest.json
  if [ ! -e "$made" ]; then
    echo "${speed_header//[^,]/}"
    return
  fi
  awk -F, -v recorded="$(json "$made" recorded_s)" -v events="$(json "$made" events)" \
    -v frames="$(json "$made" event_frames)" -v observations="$(json "$made" track_observations)" "$awk_median"'
    NR > 1 { wall = wall " " $2; cpu = cpu " " $3; memory = memory " " $4 }
    END {
      printf "%.3f,%.0f,%.2f,", recorded, events / recorded, observations / frames
      printf "%.4f,%.4f,%.5f,", recorded / median(wall), recorded / least(wall), median(wall) / recorded
      printf "%.5f,%.2f\n", median(cpu) / recorded, median(memory)
    }' "$1/times.csv"
}

header=scene,seed,method,features,threads,repeats,$speed_header,truth,tracks_judged
header+=,track_error_median_px,track_error_to_5_px_median_px,expected_age_at_5_px_share,expected_age_at_5_px_s
header+=,tracks_over_3_px_share,tracks_mostly_over_3_px_share,tracks_astray_over_3_px_share,positions_past_3_px_share
header+=,tracks_that_move_share,triangulation_residual_median_px
header+=,lifetime_frames,lifetime_s,frame_interval_s,failure

# row SCENE SEED METHOD FEATURES RESULTS
row() {
  local quality=$5/track_quality/track_quality.csv lives=$5/lifetime.csv truth judged error residual=""
  truth=$(quantity "$quality" truth name)
  judged=$(quantity "$quality" tracks_judged count)
  error=$(quantity "$quality" track_error_median px)
  local accuracy=(
    "$error" "$(quantity "$quality" track_error_median px 5.000000000)"
    "$(quantity "$quality" expected_feature_age_normalized share 5.000000000)"
    "$(quantity "$quality" expected_feature_age s 5.000000000)"
    "$(quantity "$quality" exceeding_share share 3.000000000)"
    "$(quantity "$quality" mostly_exceeding_share share 3.000000000)"
    "$(quantity "$quality" stray_share share 3.000000000)"
    "$(awk -v part="$(quantity "$quality" compared_positions count 3.000000000)" \
      -v all="$(quantity "$quality" compared_positions count)" 'BEGIN { if (all > 0) printf "%.9f", 1 - part / all }')"
    "$(awk -v part="$(quantity "$quality" tracks_moves count)" -v all="$(quantity "$quality" tracks count)" \
      'BEGIN { if (all > 0) printf "%.9f", part / all }')"
  )
  if [ "$truth" = triangulated ]; then
    residual=$error
    accuracy=("${accuracy[@]/*/}")
  fi
  local cells=(
    "$1" "$2" "$3" "$4" "$threads" "$repeats" "$(speed_cells "$5")" "$truth" "$judged"
    "${accuracy[@]}" "$residual" "$(quantity "$lives" mean frames)" "$(quantity "$lives" mean s)"
    "$(quantity "$lives" frame_interval s)" "$(failure_of "$5")"
  )
  local IFS=,
  printf '%s\n' "${cells[*]}"
}

# tracking.csv on stdin: for each scene, method and number of features the medians over the seeds, in the same columns,
# but `seeds` is their number and `failures` how many failed.
medians() {
  awk -F, -v OFS=, -v CONVFMT=%.9g "$awk_median"'
    NR == 1 {
      for (i = 1; i <= NF; ++i) is_name[i] = $i ~ /^(scene|method|truth)$/
      columns = NF
      $2 = "seeds"
      $NF = "failures"
      print
      next
    }
    {
      group = $1 OFS $3 OFS $4
      if (!seeds[group]++) groups[++count] = group
      if ($NF != "") ++failures[group]
      for (i = 1; i < NF; ++i) {
        if ($i != "") values[group, i] = is_name[i] ? $i : values[group, i] " " $i
      }
    }
    END {
      for (g = 1; g <= count; ++g) {
        group = groups[g]
        line = ""
        for (i = 1; i < columns; ++i) {
          cell = i == 2 ? seeds[group] : is_name[i] ? values[group, i] : median(values[group, i])
          line = line cell OFS
        }
        print line failures[group]
      }
    }'
}

# tracking.csv or its medians on stdin as a table to read.
print_table() {
  awk -F, '
    function cell(width, format, name, factor, value) {
      value = $at[name]
      printf "%" width "s", value == "" ? "-" : sprintf(format, factor ? factor * value : value)
    }
    NR == 1 {
      for (i = 1; i <= NF; ++i) at[$i] = i
      printf "%-22s%5s method", "scene", $2
      print "  live features    x real time     CPU    error, px    age to 5 px         over 3 px, % of tracks  tracks  resid." \
            "         lifetime"
      printf "%34s", ""
      print "  asked    mean  median   best   s/s  life to 5 px       %     s    ever  mostly  astray   pos.  judged      px" \
            "  frames     s   a frame"
      next
    }
    {
      printf "%-22s%5s %-6s", $1, $2 == "" ? "-" : $2, $3
      cell(7, "%d", "features"); cell(8, "%.1f", "mean_live_features")
      cell(8, "%.2f", "real_time_factor_median"); cell(7, "%.2f", "real_time_factor_best")
      cell(6, "%.2f", "cpu_s_per_recorded_s")
      cell(6, "%.2f", "track_error_median_px"); cell(8, "%.2f", "track_error_to_5_px_median_px")
      cell(8, "%.1f", "expected_age_at_5_px_share", 100); cell(6, "%.2f", "expected_age_at_5_px_s")
      cell(8, "%.1f", "tracks_over_3_px_share", 100); cell(8, "%.1f", "tracks_mostly_over_3_px_share", 100)
      cell(8, "%.1f", "tracks_astray_over_3_px_share", 100)
      cell(7, "%.1f", "positions_past_3_px_share", 100)
      cell(8, "%d", "tracks_judged"); cell(8, "%.2f", "triangulation_residual_median_px")
      cell(8, "%.1f", "lifetime_frames"); cell(6, "%.2f", "lifetime_s"); cell(8, "%.3f s", "frame_interval_s")
      print ($NF == "" ? "" : "  " $NF)
    }'
}

# What the EM tracker is to reach: scene, features (0: any), column, factor, comparison, limit.
targets='
  driving_day    100  real_time_factor_median     1    >=  8
  driving_day    300  real_time_factor_median     1    >=  3
  driving_day    0    track_error_median_px       1    <=  0.35
  driving_night  0    track_error_median_px       1    <=  0.5
  driving_day    0    expected_age_at_5_px_share  1    >=  0.75
  driving_night  0    expected_age_at_5_px_share  1    >=  0.65
  driving_day    0    age_share_over_klts         1    >=  1.5
  driving_night  0    age_share_over_klts         1    >=  1.5
  driving_day    0    age_s_over_klts             1    >=  1.5
  driving_night  0    age_s_over_klts             1    >=  1.5
  driving_day    0    lifetime_frames             1    >   33
  driving_night  0    lifetime_frames             1    >   29
  driving_day    0    tracks_over_3_px_share      100  <   2
  driving_night  0    tracks_over_3_px_share      100  <   4
  driving_day    0    tracks_mostly_over_3_px_share  100  <   2
  driving_night  0    tracks_mostly_over_3_px_share  100  <   4
  driving_day    0    tracks_astray_over_3_px_share  100  <   2
  driving_night  0    tracks_astray_over_3_px_share  100  <   4
  driving_day    0    positions_past_3_px_share   100  <   2
  driving_night  0    positions_past_3_px_share   100  <   4'

# The medians on stdin beside the targets of their scenes.
print_targets() {
  awk -F, -v targets="${targets//$'\n'/;}" "$awk_verdict"'
    NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; next }
    {
      for (name in at) value[$1, $3, $4, name] = $at[name]
      if ($3 == "em") { scenes[++rows] = $1; features[rows] = $4 }
    }
    END {
      n = split(targets, lines, ";")
      for (row = 1; row <= rows; ++row) {
        scene = scenes[row]
        for (i = split("share s", units, " "); i > 0; --i) {
          age = value[scene, "em", features[row], "expected_age_at_5_px_" units[i]]
          klt = value[scene, "klt", features[row], "expected_age_at_5_px_" units[i]]
          value[scene, "em", features[row], "age_" units[i] "_over_klts"] = age != "" && klt > 0 ? age / klt : ""
        }
        for (line = 1; line <= n; ++line) {
          if (split(lines[line], target, " ") == 0 || target[1] != substr(scene, 1, index(scene ":", ":") - 1)) continue
          if (target[2] > 0 && target[2] != features[row]) continue
          if (!printed++) {
            printf "\n%-22s%9s  %-31s%9s%10s\n", "Targets of em", "features", "median over the seeds", "target",
              "measured"
          }
          name = target[3]
          reached = value[scene, "em", features[row], name]
          if (reached != "") reached *= target[4]
          live = value[scene, "em", features[row], "mean_live_features"]
          note = target[2] > 0 && live < 0.9 * target[2] ? sprintf(", with %.0f alive", live) : ""
          if (target[4] == 100) sub(/_share$/, "_percent", name)
          printf "%-22s%9d  %-31s%3s%6s%10s  %s\n", scene, features[row], name, target[5], target[6],
            reached == "" ? "-" : sprintf("%.3g", reached), verdict(reached, target[5], target[6] + 0) note
        }
      }
    }'
}
