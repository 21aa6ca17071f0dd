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
cat <<END

In $PWD/$out:
  trajectory.txt                        a pose for each frame (TUM: stamp, position, quaternion)
  map.ply                               the points of the map
  tracks.txt, lifetime.csv              the feature tracks and how long they live
  summary.csv, errors.csv               the errors against the ground truth, in all and pose by pose
  plots/trajectory.svg, errors.svg,     the trajectory, its errors and the lifetimes (.pdf too)
        lifetime.svg
  images/frame_*.png                    event frames with the tracks drawn in
  manifest.json                         version, parameters, inputs, counts and times of this run
END
