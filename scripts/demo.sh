#!/usr/bin/env bash
# Installs what is missing, builds the program, runs it on the bundled sample into out/demo, and names the page to open.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
scripts/setup.sh

out=out/demo
command=(build/release/bin/evo-run run --events data_samples/street --draw-every 0.25 --out "$out")
rm -rf "$out"
printf '\n$ %s\n' "${command[*]}"
"${command[@]}"
build/release/bin/evo-run report "$out" --out "$out/report" --title "Demo of evo-run"
printf '\nOpen this page: %s\n' "$PWD/$out/report/index.html"
