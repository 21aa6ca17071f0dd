"""The whole pipeline: how well and how fast it follows the camera, in several configurations."""
from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from bench import targets
from bench.bumps import bump_stamp, judge_bump, needs_judging
from bench.configurations import OURS, Configuration, configurations
from bench.errors import BenchError
from bench.files import Row, write_csv, write_text
from bench.odometry_table import (COLUMNS, SUMMARY_COLUMNS, published_section, row_of, sections, summarize,
                                  target_rows)
from bench.options import Bench, add_common, add_recordings, add_scenes, bench_of, parser
from bench.plots import plot_bars, plot_drift
from bench.recordings import calibration_of, ground_truth_of, holds_tracks_only
from bench.record import Outcome, report
from bench.runner import Job, do, identity, is_done, key_of, mark_done, run_into
from bench.scenes import Sequence

DESCRIPTION = """\
Measures how well and how fast `evo-run run` follows the camera: a table for each scene, a row for each configuration,
medians over the seeds and in parentheses the worst; then the targets. The same goes to OUT/odometry.md, all numbers to
OUT/odometry.csv (a row a scene, seed and configuration) and OUT/odometry_summary.csv, plots to OUT/odometry_*.svg.
A recording may also be a folder of given tracks: tracks.txt, the calibration and the ground truth. Called again, only
what was made with another build, other parameters or another sequence is done again. The scene `bumps` is compared
with `bumps_level`, the same without any bump, which is made beside it. A run that fails has a row that says so, and
the exit code is 1."""
EXAMPLES = """\
examples:
  python3 -m bench odometry                         # ours, the paper's configuration, 300 features
  python3 -m bench odometry --seeds 1 turns:2+8 bumps:3+8
  python3 -m bench odometry --seeds 1,2,3,4,5,6,7,8,9,10 --config ours driving_day:60
  python3 -m bench odometry --set odometry.window=12 --set "odometry.window=12 odometry.loss_px=2" driving_day:60
  python3 -m bench odometry --recording /data/street_12s --recording /data/uzh_boxes_6dof_tracks"""
ABLATION_DESCRIPTION = """\
As `odometry`, with ours and one of its ingredients switched off at a time; tables are OUT/ablation*. The final
refinement mends much of what goes before it: --set "odometry.final_refinement=false NAME=VALUE" shows an ingredient
without it. The ingredients:
  """ + "\n  ".join(targets.ABLATIONS)
ABLATION_EXAMPLES = """\
examples:
  python3 -m bench ablation
  python3 -m bench ablation --seeds 1,2,3 driving_day:20+8 bumps:3+8 driving_night:20+8"""


@dataclass(frozen=True)
class Run:
    """A recording followed in a configuration."""

    label: str
    seed: str
    configuration: Configuration
    folder: Path
    results: Path
    interval: tuple[str, ...] = ()
    bump: float | None = None
    cost: float = 1.0

    def options(self) -> list[str]:
        """The options that the results depend on."""
        return [*self.configuration.options, *self.interval]


def key(bench: Bench, run: Run) -> str:
    """What the results of a run depend on."""
    return key_of(bench.program, run.options(), f"threads {bench.threads}", run.configuration.contents(),
                  identity(run.folder))


def follow(bench: Bench, run: Run) -> None:
    """Runs on a recording, or on given tracks, which are judged by themselves."""
    given = holds_tracks_only(run.folder)
    if given:
        arguments = ["odometry", "--tracks", str(run.folder / "tracks.txt"),
                     "--calibration", str(calibration_of(run.folder))]
    else:
        arguments = ["run", "--events", str(run.folder), "--no-plots"]
    if not run_into(run.results, bench.program, [*arguments, "--threads", str(bench.threads), *run.options()]):
        return
    if given:
        judge_trajectory(bench, run)
    mark_done(run.results, key(bench, run))


def judge_trajectory(bench: Bench, run: Run) -> None:
    """Judges against the truth beside given tracks; without sim3 where a straight line does not determine it."""
    truth = ground_truth_of(run.folder)
    if truth is None:
        return
    covariances = run.results / "pose_covariance.csv"
    options = ["--covariances", str(covariances)] if covariances.exists() else []
    message = ""
    for alignments in ("origin-scale,sim3", "origin-scale"):
        try:
            bench.program.output("evaluate", "--estimate", str(run.results / "trajectory.txt"), *options,
                                 "--ground-truth", str(truth), "--align", alignments, "--no-plots", "--quiet",
                                 "--force", "--out", str(run.results / "judged"))
            return
        except BenchError as error:
            message = str(error)
    write_text(run.results / "judging.txt", f"{message}\n")


def simulate(bench: Bench, ablation: bool) -> list[tuple[str, str, Sequence, float | None]]:
    """Label, folder's name, sequence and bump of all scenes and seeds, simulated where they are missing."""
    simulator = bench.simulator()
    level = bench.simulator((f"{targets.BUMPS_AT}=",), "level")
    places = []
    for scene in bench.scenes:
        for seed in bench.seeds:
            sequence = simulator.sequence(scene, seed)
            places.append((sequence.label, sequence.name, sequence))
            if scene.name == "bumps" and not ablation:
                sequence = level.sequence(scene, seed)
                places.append((f"bumps_level:{sequence.part}", f"level/{sequence.name}", sequence))
    do(simulator.missing([sequence for _, _, sequence in places]), bench.jobs)
    return [(label, name, sequence,
             None if name.startswith("level/")
             else bump_stamp(sequence, simulator.parameters(sequence.scene, sequence.seed)))
            for label, name, sequence in places]


def runs_of(bench: Bench, found: list[Configuration], ablation: bool) -> tuple[list[Run], list[Path]]:
    """All runs, scenes before recordings, and the folders of the sequences."""
    runs, folders = [], []
    for label, name, sequence, bump in simulate(bench, ablation):
        folders.append(sequence.folder)
        runs += [Run(label, sequence.seed, item, sequence.folder, bench.out / name / item.folder, (), bump,
                     float(sequence.part.seconds)) for item in found]
    for recording in bench.recordings:
        runs += [Run(recording.label, "", item, recording.folder,
                     bench.out / "recordings" / recording.name / item.folder, tuple(recording.interval), None, 10.0)
                 for item in found]
    return runs, folders


def measure(bench: Bench, runs: list[Run]) -> None:
    """Does what is missing: runs one at a time, evaluations --jobs at a time."""
    do([Job(f"run        {run.results}", lambda run=run: follow(bench, run), run.cost)
        for run in runs if not is_done(run.results, key(bench, run))])
    do([Job(f"judge      {run.results}/bump",
            lambda run=run: judge_bump(bench.program, run.results, run.folder, run.bump))
        for run in runs if needs_judging(run.results, run.bump)], bench.jobs)


def figures(bench: Bench, table: str, runs: list[Run], summary: list[Row]) -> list[str]:
    """The mean planar error of every scene, and the error over the distance on the first."""
    drawn = plot_bars(bench.out, f"{table}_error", "mean planar error, % of the path", summary, "scene", "config",
                      "mean_planar_percent_median")
    first = [run for run in runs if (run.label, run.seed) == (runs[0].label, runs[0].seed)]
    files = [(run.configuration.label, folder / "errors.csv") for run in first
             for folder in (run.results, run.results / "judged") if (folder / "errors.csv").exists()]
    name = first[0].label + (f", seed {first[0].seed}" if first[0].seed else "")
    return drawn + plot_drift(bench.out, f"{table}_drift", name, files)


def main(words: list[str], ablation: bool = False) -> int:
    """python3 -m bench odometry, and ablation."""
    table = "ablation" if ablation else "odometry"
    default = targets.ABLATION_SCENES if ablation else targets.ODOMETRY_SCENES
    options = parser(table, ABLATION_DESCRIPTION if ablation else DESCRIPTION,
                     ABLATION_EXAMPLES if ablation else EXAMPLES)
    add_scenes(options, default)
    add_recordings(options)
    options.add_argument("--config", action="append", default=[], metavar="NAME", dest="configs",
                         help="`ours`, the program's defaults; a file in configs, such as `paper`; or a file; may be "
                              "repeated; default: ours and paper, and ours with 300 features; with --set: ours")
    options.add_argument("--set", action="append", default=[], metavar='"NAME=VALUE..."', dest="variants",
                         help="another configuration: ours but for these parameters, between blanks; may be repeated")
    add_common(options, "out/bench_odometry")
    arguments = options.parse_intermixed_args(words)
    bench = bench_of(arguments, table, words, default)
    for recording in bench.recordings:
        if recording.part and holds_tracks_only(recording.folder):
            raise BenchError(f"{recording.label}: of given tracks, no part can be taken")
    variants = [*targets.ABLATIONS, *arguments.variants] if ablation else arguments.variants
    names = arguments.configs or ([OURS] if variants else [OURS, "paper"])
    if not arguments.configs and not variants:
        variants = [targets.MORE_FEATURES]
    found = configurations(names, variants, bench.program)

    runs, folders = runs_of(bench, found, ablation)
    measure(bench, runs)
    rows = [row_of(run.label, run.seed, run.configuration.label, run.results, run.folder) for run in runs]
    summary = summarize(rows)
    write_csv(bench.out / f"{table}.csv", COLUMNS, rows)
    write_csv(bench.out / f"{table}_summary.csv", SUMMARY_COLUMNS, summary)
    published = None if ablation else published_section(summary)
    tables = sections(summary) + ([published] if published else [])
    return report(bench, Outcome(table, tables, [] if ablation else target_rows(summary, found[0].label),
                                 [run.results for run in runs], folders, figures(bench, table, runs, summary),
                                 failed=any(row["failure"] for row in rows)))
