"""The whole pipeline on drives that are drawn at random: the distribution of its errors, and the worst drives."""
from __future__ import annotations

import argparse
import re
from dataclasses import dataclass
from pathlib import Path

from bench import targets
from bench.files import write_csv
from bench.options import Bench, Parser, add_common, bench_of, list_of, name_value, parser, positive
from bench.recordings import calibration_of, ground_truth_of
from bench.record import Outcome, report
from bench.runner import Job, do, identity, is_done, key_of, mark_done, run_into
from bench.scenes import Part, Scene, Sequence, Simulator, parse_scene
from bench.worlds_table import COLUMNS, row_of, sections, target_rows

DESCRIPTION = """\
Draws drives from configs/scenes/random.yaml, a seed a drive, simulates each, follows it with the default parameters and
prints the distribution of the errors with the worst drives and what they have in common. The same goes to
OUT/worlds.md, all numbers to OUT/worlds.csv, a row a drive and method. Each drive's events are deleted after its runs;
the drawn scene stays in SEQUENCES/random_SEED_SECONDS/scene.yaml. Called again, only what was made with another build,
other parameters or another scene is done again.

Seeds 1 to 999 are for tuning. Seeds 1001 to 1100 are held back for reporting: of them only the distribution is shown,
so that nobody comes to know one of these drives. With --jobs above 1 the speed says nothing."""
EXAMPLES = """\
examples:
  python3 -m bench worlds --seeds 1-20
  python3 -m bench worlds --seeds 3,7 --methods em --keep --set tracker.features=300
  python3 -m bench worlds --seeds 1001-1100 --jobs 2"""
HELD_BACK = range(1001, 1101)
# True depth and images are not needed: they cost time and disk.
SIMULATION = ("simulation.depth_hz=0", "simulation.image_hz=0")


def seed_list(text: str) -> list[str]:
    """The type of seeds between commas, with ranges such as 1-20."""
    seeds: list[str] = []
    for part in text.split(","):
        match = re.fullmatch(r"([0-9]+)(?:-([0-9]+))?", part)
        if not match or int(match[2] or match[1]) < int(match[1]):
            raise argparse.ArgumentTypeError(f"cannot be '{text}': such as 1-20 or 3,5,8-10")
        seeds += [str(seed) for seed in range(int(match[1]), int(match[2] or match[1]) + 1)]
    return list(dict.fromkeys(seeds))


@dataclass(frozen=True)
class Run:
    """A drive followed with a method."""

    sequence: Sequence
    method: str
    settings: tuple[str, ...]  # NAME=VALUE
    results: Path
    camera_height: str  # m, as text

    @property
    def options(self) -> list[str]:
        """The options that the results depend on."""
        values = ([] if self.method == "em" else [f"{targets.METHOD}={self.method}"]) + list(self.settings)
        return [word for value in values for word in ("--set", value)]


def key(bench: Bench, run: Run) -> str:
    """What the results of a run depend on."""
    return key_of(bench.program, run.options, f"threads {bench.threads}", run.sequence.made_from)


def follow(bench: Bench, run: Run) -> None:
    """Follows a drive, then again from its tracks with the camera's height given, which makes the scale metric."""
    folder, threads = run.sequence.folder, ["--threads", str(bench.threads)]
    if run_into(run.results, bench.program, ["run", "--events", str(folder), "--no-plots", *threads, *run.options]):
        metric = run.results / "metric"
        options = ["--tracks", str(run.results / "tracks.txt"), "--calibration", str(calibration_of(folder)),
                   *threads, *run.options, "--set", f"{targets.CAMERA_HEIGHT}={run.camera_height}"]
        if run_into(metric, bench.program, ["odometry", *options]):
            run_into(metric / "judged", bench.program,
                     ["evaluate", "--estimate", str(metric / "trajectory.txt"), "--ground-truth",
                      str(ground_truth_of(folder)), "--align", "origin-scale", "--no-plots"])
    mark_done(run.results, key(bench, run))


def do_world(bench: Bench, simulator: Simulator, runs: list[Run], keep: bool) -> None:
    """Simulates a drive, follows it with each method, and deletes its events."""
    sequence = runs[0].sequence
    for job in simulator.missing([sequence]):
        job.action()
    for run in runs:
        if not is_done(run.results, key(bench, run)):
            follow(bench, run)
    if not keep:
        sequence.delete_events()


def runs_of(bench: Bench, simulator: Simulator, scene: Scene, arguments: argparse.Namespace) -> list[list[Run]]:
    """The runs of each drive."""
    worlds = []
    for seed in bench.seeds:
        sequence = simulator.sequence(scene, seed)
        height = simulator.parameters(scene, seed)[targets.TRUE_CAMERA_HEIGHT]
        worlds.append([Run(sequence, method, tuple(arguments.set), bench.out / sequence.name / method, height)
                       for method in arguments.methods])
    return worlds


def add_arguments(options: Parser) -> None:
    """The options of the benchmark."""
    options.add_argument("--seeds", type=seed_list, default=seed_list("1-20"), metavar="LIST",
                         help="of the drives, such as 1-20 or 3,5,8-10; default 1-20")
    options.add_argument("--scene", default="random", metavar="SCENE",
                         help="a name in configs/scenes or a scene file; default random")
    options.add_argument("--duration", default="8", type=lambda text: list_of("[0-9.]+")(text)[0], metavar="SECONDS",
                         help="of each drive, from its start; default 8")
    options.add_argument("--methods", type=list_of("em|klt"), default=["em", "klt"], metavar="LIST",
                         help="em, klt or both; default em,klt")
    options.add_argument("--set", type=name_value, action="append", default=[], metavar="NAME=VALUE",
                         help="a parameter of `evo-run run`; may be repeated")
    options.add_argument("--worst", type=positive, default=5, metavar="N", help="drives that are shown; default 5")
    options.add_argument("--keep", action="store_true", help="keep the events: 5 to 40 MB for each second")
    options.add_argument("--sequences", type=Path, default=Path("out/worlds"), metavar="DIR",
                         help="simulated drives; default out/worlds")
    add_common(options, "out/bench_worlds")


def main(words: list[str]) -> int:
    """python3 -m bench worlds."""
    options = parser("worlds", DESCRIPTION, EXAMPLES)
    add_arguments(options)
    arguments = options.parse_args(words)
    bench = bench_of(arguments, "worlds", words, [])
    simulator = bench.simulator(SIMULATION)
    scene = Scene(parse_scene(arguments.scene).file, Part("", arguments.duration))
    worlds = runs_of(bench, simulator, scene, arguments)
    do([Job(f"world      {runs[0].sequence.folder}",
            lambda runs=runs: do_world(bench, simulator, runs, arguments.keep))
        for runs in worlds if not all(is_done(run.results, key(bench, run)) for run in runs)], bench.jobs)

    held_back = any(int(seed) in HELD_BACK for seed in bench.seeds)
    rows = [row_of(run.sequence, run.method, run.results) for runs in worlds for run in runs]
    write_csv(bench.out / "worlds.csv", COLUMNS, rows)
    tables = sections(rows, simulator, scene, 0 if held_back else arguments.worst)
    return report(bench, Outcome("worlds", tables, target_rows(rows), [run.results for runs in worlds for run in runs],
                                 [runs[0].sequence.folder for runs in worlds]))
