#!/usr/bin/env bash
# Makes docs/figures/overview.png again: a simulated turn, its event frames with tracks, and its path.
# Needs rsvg-convert (package librsvg2-bin) and a built program.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
evo_run=build/release/bin/evo-run
out=out/overview
[ -d "$out/turns" ] || "$evo_run" simulate configs/scenes/turns.yaml --from 2 --duration 8 --out "$out/turns"
"$evo_run" run --events "$out/turns" --draw-every 4 --out "$out/run" --force

data_uri() { printf 'data:image/%s;base64,%s' "$1" "$(base64 --wrap=0 "$2")"; }
rsvg-convert --width 640 "$out/run/plots/trajectory.svg" --output "$out/trajectory.png"
cat >"$out/overview.svg" <<END
<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" viewBox="0 0 1120 480">
<rect width="1120" height="480" fill="white"/>
<image x="0" y="0" width="630" height="480" xlink:href="$(data_uri png "$out/run/images/four_frames_0004.000s.png")"/>
<image x="640" y="0" width="480" height="480" xlink:href="$(data_uri png "$out/trajectory.png")"/>
</svg>
END
rsvg-convert --unlimited --width 1120 "$out/overview.svg" --output docs/figures/overview.png
