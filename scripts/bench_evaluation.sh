#!/bin/sh
# Times `evo-run evaluate` on N estimated poses against N true ones and prints the minimum, median and maximum of each
# stage's wall time over R runs. Usage: scripts/bench_evaluation.sh [N [R [option of evaluate...]]]
set -eu
cd "$(dirname "$0")/.."
poses=${1:-100000}
runs=${2:-5}
[ $# -lt 2 ] || shift 2
evo_run=${EVO_RUN:-build/release/bin/evo-run}
[ -x "$evo_run" ] || { echo "$evo_run is missing; build first: scripts/test.sh, or name it in EVO_RUN" >&2; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# A drive at 20 Hz and 10 m/s through gentle curves over hills; the estimate drifts in scale, heading and position.
drive() {
  awk -v n="$poses" -v drift="$1" 'BEGIN {
    for (i = 0; i < n; ++i) {
      heading = 0.4 * sin(i / 900) + drift * i / n
      step = 0.5 * (1 + 0.1 * drift * sin(i / 5000))
      x += step * sin(heading)
      z += step * cos(heading)
      y = 2 * sin(i / 700) + drift * 0.01 * sin(i / 7)
      printf "%.9f %.9f %.9f %.9f 0 %.12f 0 %.12f\n", 1500000000 + i / 20, x, y, z, sin(heading / 2), cos(heading / 2)
    }
  }'
}
drive 0 > "$work/truth.txt"
drive 0.05 > "$work/estimate.txt"

for run in $(seq "$runs"); do
  "$evo_run" evaluate --estimate "$work/estimate.txt" --ground-truth "$work/truth.txt" --no-plots --out "$work/$run" "$@" \
    > "$work/summary" 2> "$work/log" || { cat "$work/log" >&2; exit 1; }
done
cat "$work/summary"
echo "wall time over $runs runs, s: minimum, median, maximum"
for stage in read evaluate write; do
  sed -n "s/^ *\"$stage\": \([0-9.e-]*\),*$/\1/p" "$work"/*/manifest.json | sort -g |
    awk -v stage="$stage" '{ t[NR] = $1 } END { printf "%-10s %8.3f %8.3f %8.3f\n", stage, t[1], t[int((NR + 1) / 2)], t[NR] }'
done
