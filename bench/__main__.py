"""python3 -m bench COMMAND: the benchmarks of evo-run."""
from __future__ import annotations

import importlib
import signal
import sys

from bench.errors import BenchError

COMMANDS = {
    "tracking": "bench.tracking",
    "scaling": "bench.scaling",
    "scenes": "bench.scene_costs",
    "odometry": "bench.odometry",
    "ablation": "bench.odometry",
    "worlds": "bench.worlds",
    "evaluation": "bench.evaluation",
    "all": "bench.all_benchmarks",
    "docs": "bench.docs",
    "compare": "bench.compare_builds",
}
HELP = """\
usage: python3 -m bench COMMAND [OPTION...]      (--help after a command lists its options, with examples)

  tracking     speed, accuracy and lifetimes of the tracker, EM and KLT
  scaling      time and memory of the tracker against events, features and length
  scenes       what the simulated scenes are like, cost, and how they are followed
  odometry     errors, coverage and speed of the whole pipeline: ours, the paper's, variants
  ablation     the odometry with one ingredient switched off at a time
  worlds       the whole pipeline on drives that are drawn at random
  evaluation   time of the evaluation
  all          all of these; --quick in about 25 minutes on two cores
  docs         writes docs/benchmarks.md from the results of one build
  compare      compares the outputs of two builds byte by byte

examples:
  python3 -m bench all --quick --recording data_samples/street && python3 -m bench docs
  python3 -m bench tracking --seeds 1,2 driving_day:20+8
  python3 -m bench odometry --seeds 1 --config ours --config paper turns:2+8
  python3 -m bench compare old/build/release/bin/evo-run build/release/bin/evo-run

EVO_RUN names the program; without it build/release/bin/evo-run is brought up to date and used.
Results stay in out/; a benchmark that is called again goes on where it ended.
"""


def main(words: list[str]) -> int:
    """Runs a command and returns its exit code: 0 done, 1 something failed, 2 a wrong command line."""
    if not words or words[0] in ("-h", "--help"):
        print(HELP, end="")
        return 0 if words else 2
    name = words[0]
    try:
        if name not in COMMANDS:
            raise BenchError(f"there is no command {name}; see --help")
        module = importlib.import_module(COMMANDS[name])
        return module.main(words[1:]) if name != "ablation" else module.main(words[1:], ablation=True)
    except BenchError as error:
        print(f"bench {name}: error: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print(f"bench {name}: interrupted; called again it goes on from here", file=sys.stderr)
        return 130


def _interrupt(*_: object) -> None:
    raise KeyboardInterrupt


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, _interrupt)
    sys.exit(main(sys.argv[1:]))
