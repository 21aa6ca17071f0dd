"""The time of `evo-run evaluate` on many poses."""
from __future__ import annotations

import argparse
import math
from pathlib import Path

from bench.files import Row, Value, write_text, write_csv
from bench.measures import Manifest, failure_of
from bench.options import Bench, add_common, bench_of, parser, positive
from bench.record import Outcome, Section, report
from bench.runner import Job, do, is_done, key_of, mark_done, run_into
from bench.tables import Column, median

DESCRIPTION = """\
Times `evo-run evaluate` on N estimated poses against N true ones: minimum, median and maximum of each stage's wall
time. The estimate drifts in scale, heading and position. The table goes to stdout and OUT/evaluation.md."""
EXAMPLES = """\
examples:
  python3 -m bench evaluation
  python3 -m bench evaluation --poses 10000 --repeats 3 -- --align none,sim3:5s --rpe 1f,10m"""
STAGES = ["read", "evaluate", "write"]
COLUMNS = [
    Column("stage", "stage"),
    Column("least, s", "least", ".3f", meaning="Least wall time of the repetitions."),
    Column("median, s", "median", ".3f", meaning="Median wall time."),
    Column("largest, s", "largest", ".3f", meaning="Largest wall time."),
]


def drive(poses: int, drift: float) -> str:
    """A drive at 20 Hz and 10 m/s through gentle curves over hills, as TUM text."""
    lines = []
    x = z = 0.0
    for i in range(poses):
        heading = 0.4 * math.sin(i / 900) + drift * i / poses
        step = 0.5 * (1 + 0.1 * drift * math.sin(i / 5000))
        x += step * math.sin(heading)
        z += step * math.cos(heading)
        y = 2 * math.sin(i / 700) + drift * 0.01 * math.sin(i / 7)
        lines.append(f"{1500000000 + i / 20:.9f} {x:.9f} {y:.9f} {z:.9f} "
                     f"0 {math.sin(heading / 2):.12f} 0 {math.cos(heading / 2):.12f}")
    return "\n".join(lines) + "\n"


def measure(bench: Bench, folder: Path, poses: int, repeats: int, options: list[str]) -> None:
    """Evaluates what is not evaluated already; every run counts."""
    key = key_of(bench.program, [str(poses), *options])
    left = [run for run in range(1, repeats + 1) if not is_done(folder / str(run), key)]
    if not left:
        return
    write_text(folder / "truth.txt", drive(poses, 0.0))
    write_text(folder / "estimate.txt", drive(poses, 0.05))
    arguments = ["evaluate", "--estimate", str(folder / "estimate.txt"), "--ground-truth", str(folder / "truth.txt"),
                 "--no-plots", *options]

    def run_once(results: Path) -> None:
        if run_into(results, bench.program, arguments):
            mark_done(results, key)
    do([Job(f"run        {folder / str(run)}", lambda run=run: run_once(folder / str(run))) for run in left])


def rows_of(folder: Path, repeats: int) -> list[Row]:
    """A row for each stage."""
    manifests = [Manifest(folder / str(run) / "manifest.json") for run in range(1, repeats + 1)]
    rows: list[Row] = []
    for stage in STAGES:
        known: list[Value] = [time for time in (item.stage_s(stage) for item in manifests) if time is not None]
        rows.append({"stage": stage, "least": min(known, default=None), "median": median(known),  # type: ignore[type-var]
                     "largest": max(known, default=None)})  # type: ignore[type-var]
    return rows


def main(words: list[str]) -> int:
    """python3 -m bench evaluation."""
    options = parser("evaluation", DESCRIPTION, EXAMPLES)
    options.add_argument("--poses", type=positive, default=100000, metavar="N", help="default 100000")
    options.add_argument("--repeats", type=positive, default=5, metavar="N", help="default 5")
    options.add_argument("options", nargs=argparse.REMAINDER, metavar="-- OPTION...", help="more options of evaluate")
    add_common(options, "out/bench_evaluation")
    arguments = options.parse_args(words)
    bench = bench_of(arguments, "evaluation", words, [])
    more = arguments.options[1:] if arguments.options[:1] == ["--"] else arguments.options
    folder = bench.out / f"{arguments.poses}"
    measure(bench, folder, arguments.poses, arguments.repeats, more)
    rows = rows_of(folder, arguments.repeats)
    write_csv(bench.out / "evaluation.csv", ["stage", "least", "median", "largest"], rows)
    results = [folder / str(run) for run in range(1, arguments.repeats + 1)]
    title = f"Wall time of evaluating {arguments.poses} poses against as many, {arguments.repeats} runs"
    return report(bench, Outcome("evaluation", [Section(title, COLUMNS, rows)], [], results,
                                 failed=any(failure_of(item) for item in results)))
