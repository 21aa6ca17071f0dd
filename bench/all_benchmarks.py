"""All benchmarks, one after the other."""
from __future__ import annotations

import importlib
import sys
from pathlib import Path

from bench import profiles
from bench.errors import BenchError
from bench.options import parser, positive
from bench.program import find_program
from bench.recordings import parse_recording

DESCRIPTION = """\
Runs all benchmarks into their usual folders: tracking, scaling, scenes, odometry, ablation, worlds and evaluation.
Interrupted and called again it goes on where it ended. `python3 -m bench docs` then writes docs/benchmarks.md. In full it takes
hours; --quick takes about 25 minutes on two cores (few seeds and short parts, no scaling)."""
EXAMPLES = """\
examples:
  python3 -m bench all --quick
  python3 -m bench all --quick --recording data_samples/street
  python3 -m bench all --out /data/out --recording /data/street_12s"""
MODULES = {"tracking": "bench.tracking", "scaling": "bench.scaling", "scenes": "bench.scene_costs",
           "odometry": "bench.odometry", "ablation": "bench.odometry", "worlds": "bench.worlds",
           "evaluation": "bench.evaluation"}
FOLDERS = {"tracking": "bench_tracking", "scaling": "bench_tracking", "scenes": "bench_scenes",
           "odometry": "bench_odometry", "ablation": "bench_odometry", "worlds": "bench_worlds",
           "evaluation": "bench_evaluation"}
WITH_RECORDINGS = ("tracking", "odometry")


def words_of(name: str, words: list[str], out: Path, recordings: list[str], common: list[str]) -> list[str]:
    """The command line of a step."""
    words = [*common, "--out", str(out / FOLDERS[name]), *words]
    if name != "evaluation":
        words = ["--sequences", str(out / "scenes"), *words]
    if name in WITH_RECORDINGS:
        words += [word for recording in recordings for word in ("--recording", recording)]
    return words


def main(words: list[str]) -> int:
    """python3 -m bench all."""
    options = parser("all", DESCRIPTION, EXAMPLES)
    options.add_argument("--quick", action="store_true", help="few seeds and short parts")
    options.add_argument("--recording", action="append", default=[], metavar="FOLDER[:[FROM+]SECONDS]",
                         dest="recordings", help="also this recording; may be repeated")
    options.add_argument("--out", type=Path, default=Path("out"), metavar="DIR", help="default out")
    options.add_argument("--threads", type=positive, default=2, metavar="N", help="of each run; default 2")
    options.add_argument("--jobs", type=positive, default=1, metavar="N", help="simulations and evaluations at a time")
    options.add_argument("--evo-run", metavar="FILE", help="the program; default: EVO_RUN, else the release build")
    arguments = options.parse_args(words)
    for recording in arguments.recordings:
        parse_recording(recording)
    program = find_program(arguments.evo_run)
    common = ["--threads", str(arguments.threads), "--jobs", str(arguments.jobs), "--evo-run", str(program.path)]
    steps = profiles.QUICK if arguments.quick else profiles.FULL
    failed = False
    for number, (name, step) in enumerate(steps, 1):
        print(f"\n# {name}: {number} of {len(steps)}\n", flush=True)
        module = importlib.import_module(MODULES[name])
        more = {"ablation": True} if name == "ablation" else {}
        try:
            failed |= module.main(words_of(name, step, arguments.out, arguments.recordings, common), **more) != 0
        except BenchError as error:
            print(f"bench {name}: error: {error}", file=sys.stderr)
            failed = True
    return 1 if failed else 0
