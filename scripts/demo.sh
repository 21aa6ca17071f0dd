#!/usr/bin/env bash
# Sets up, runs the bundled sample into out/demo (always anew) and says where the results are.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
scripts/setup.sh

out=out/demo
command=(build/release/bin/evo-run run --events data_samples/street --draw-every 0.25 --out "$out")
rm -rf "$out"
printf '\n$ %s\n' "${command[*]}"
"${command[@]}"
build/release/bin/evo-run report "$out" --out "$out/report" --title "Demo of evo-run"
cat <<END

In $PWD/$out:
  report/index.html                     one page with everything below
  trajectory.txt, map.ply               a pose for each frame (TUM: stamp, position, quaternion); the points of the map
  pose_covariance.csv                   how uncertain each pose is
  tracks.txt, lifetime.csv              the feature tracks and how long they live
  summary.csv, metrics.csv, errors.csv  the errors against the ground truth, in all, all statistics, and pose by pose
  tables/*.tex                          lifetimes and errors for a paper
  plots/*.svg, *.pdf                    trajectory, errors, scale drift, lifetimes, live features
  images/four_frames_*.png              event frames with the tracks drawn in
  manifest.json                         version, parameters, inputs, counts and times of this run
END
