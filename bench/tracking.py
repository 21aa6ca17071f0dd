"""The tracker alone: speed, accuracy and lifetimes of its methods on scenes and recordings."""
from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Sequence

from bench import targets
from bench.errors import BenchError
from bench.files import read_text, write_csv, write_text
from bench.measures import Manifest, last_track_stamp
from bench.options import (Bench, add_common, add_recordings, add_scenes, bench_of, list_of, name_value, parser,
                           positive)
from bench.recordings import calibration_of, ground_truth_of
from bench.record import Outcome, report
from bench.runner import Job, do, identity, is_done, key_of, mark_done, run_into
from bench.tracking_table import COLUMNS, Case, row_of, sections, summarize, target_rows

DESCRIPTION = """\
Measures how fast and how well `evo-run track` tracks, with both of its methods: every scene, seed, method and number
of features, then the medians over the seeds, then the targets. The tables go to stdout and OUT/tracking.md, the
numbers to OUT/tracking.csv and OUT/tracking_medians.csv. Called again, only what was made with another build, other
settings or another sequence is measured again. A run that fails has a row that says so, and the exit code is 1.

Wall time is that of reading, tracking and writing tracks.txt. CPU time is that of the process, which stays about the
same on a busy machine. --draw-every draws OUT/SCENE_SEED_PART/METHOD_FEATURES/drawn/images, not timed."""
EXAMPLES = """\
examples:
  python3 -m bench tracking
  python3 -m bench tracking --seeds 1 --methods em --features 100 driving_day:20+8
  python3 -m bench tracking --set tracker.patch_radius_px=10 --out out/patch_10 driving_day:20+8
  python3 -m bench tracking --recording data_samples/street --recording /data/outdoor_day2:12+60
  python3 -m bench tracking --draw-every 2 --seeds 1 driving_night:20+8"""
DRAWN_KEY = "every.txt"


@dataclass(frozen=True)
class Settings:
    """How each case is tracked."""

    methods: list[str]
    features: list[str]
    repeats: int
    settings: list[str]  # NAME=VALUE
    draw_every: str | None = None


def add_tracking_options(to, features: str = "100,300") -> None:
    """Methods, numbers of features, parameters and repetitions."""
    to.add_argument("--methods", type=list_of("em|klt"), default=["em", "klt"], metavar="LIST", help="default em,klt")
    to.add_argument("--features", type=list_of("[1-9][0-9]*"), default=features.split(","), metavar="LIST",
                    help=f"live features to aim at; default {features}")
    to.add_argument("--set", type=name_value, action="append", default=[], metavar="NAME=VALUE", dest="settings",
                    help="a parameter of `evo-run track`; may be repeated")
    to.add_argument("--repeats", type=positive, default=3, metavar="N", help="timed runs of each; default 3")


def settings_of(arguments) -> Settings:
    """The checked settings."""
    for setting in arguments.settings:
        if setting.partition("=")[0] in (targets.METHOD, targets.FEATURES):
            raise BenchError("--set cannot change these; see --methods and --features")
    return Settings(arguments.methods, arguments.features, arguments.repeats, arguments.settings,
                    getattr(arguments, "draw_every", None))


def options_of(settings: Settings, case: Case) -> list[str]:
    """The options that a case's results depend on."""
    values = [*settings.settings, f"{targets.METHOD}={case.method}", f"{targets.FEATURES}={case.features}"]
    return [word for value in values for word in ("--set", value)] + list(case.options)


def key(bench: Bench, settings: Settings, case: Case) -> str:
    """What the results of a case depend on."""
    repeats = f"threads {bench.threads}, repeats {settings.repeats}"
    return key_of(bench.program, options_of(settings, case), repeats, identity(case.folder))


def track(bench: Bench, settings: Settings, case: Case) -> None:
    """Tracks a recording `repeats` times; the results are those of the last run, which are the same for all."""
    arguments = ["track", "--events", str(case.folder), "--threads", str(bench.threads), "--no-plots",
                 *options_of(settings, case)]
    times = []
    for run in range(1, settings.repeats + 1):
        if not run_into(case.results, bench.program, arguments):
            break
        manifest = Manifest(case.results / "manifest.json")
        wall = (manifest.stage_s("track") or 0.0) + (manifest.stage_s("write_tracks") or 0.0)
        times.append({"run": run, "wall_s": wall, "cpu_s": manifest.value("cpu_time_s"),
                      "peak_memory_mb": manifest.value("peak_memory_mb")})
    write_csv(case.results / "times.csv", ["run", "wall_s", "cpu_s", "peak_memory_mb"], times)
    if (case.results / "complete").exists():
        mark_done(case.results, key(bench, settings, case))


def draw(bench: Bench, settings: Settings, case: Case) -> None:
    """Draws the tracks in a run of its own."""
    options = ["track", "--events", str(case.folder), "--draw-every", str(settings.draw_every), "--no-plots",
               *options_of(settings, case), "--force", "--quiet"]
    drawn = case.results / "drawn"
    bench.program.output(*options, "--out", str(drawn))
    write_text(drawn / DRAWN_KEY, f"{settings.draw_every}\n")


def judge(bench: Bench, case: Case) -> None:
    """Judges the tracks of a case by its truth, up to the last frame: the recording may go on."""
    truth, stamp = ground_truth_of(case.folder), last_track_stamp(case.results / "tracks.txt")
    calibration = calibration_of(case.folder)
    if truth is None or calibration is None or stamp is None:
        return
    judge_tracks(bench, case.results, truth, calibration, ["--no-plots", "--to-stamp", stamp])


def judge_tracks(bench: Bench, results: Path, truth: Path, calibration: Path, options: Sequence[str]) -> None:
    """Judges RESULTS/tracks.txt into RESULTS/track_quality; judging.txt keeps the message of a failure."""
    message = results / "judging.txt"
    try:
        bench.program.output("evaluate", "--tracks", str(results / "tracks.txt"), "--ground-truth", str(truth),
                             "--calibration", str(calibration), "--out", str(results / "track_quality"), "--quiet",
                             "--force", *options)
        message.unlink(missing_ok=True)
    except BenchError as error:
        write_text(message, f"{error}\n")


def track_all(bench: Bench, settings: Settings, cases: list[Case]) -> None:
    """Tracks what is not done already, one run at a time."""
    do([Job(f"run        {case.results}", lambda case=case: track(bench, settings, case),
            case.cost * settings.repeats)
        for case in cases if not is_done(case.results, key(bench, settings, case))])


def draw_all(bench: Bench, settings: Settings, cases: list[Case]) -> None:
    """Draws what is to be drawn and is not drawn already."""
    if settings.draw_every is None:
        return
    do([Job(f"draw       {case.results}/drawn/images", lambda case=case: draw(bench, settings, case), case.cost)
        for case in cases if (case.results / "complete").exists()
        and read_text(case.results / "drawn" / DRAWN_KEY) != f"{settings.draw_every}\n"], bench.jobs)


def judge_all(bench: Bench, cases: list[Case]) -> None:
    """Judges what is not judged already."""
    do([Job(f"judge      {case.results}", lambda case=case: judge(bench, case), case.cost) for case in cases
        if (case.results / "tracks.txt").exists() and ground_truth_of(case.folder) is not None
        and not (case.results / "track_quality" / "manifest.json").exists()], bench.jobs)


def cases_of(bench: Bench, settings: Settings) -> tuple[list[Case], list[Path]]:
    """All cases, and the folders of the sequences, which are simulated where they are missing."""
    simulator = bench.simulator()
    sequences = [simulator.sequence(scene, seed) for scene in bench.scenes for seed in bench.seeds]
    do(simulator.missing(sequences), bench.jobs)
    places = [(item.label, item.seed, item.folder, item.name, [], float(item.part.seconds)) for item in sequences]
    places += [(item.label, "", item.folder, f"recordings/{item.name}", item.interval, 10.0)
               for item in bench.recordings]
    cases = [Case(label, seed, method, int(count), folder, bench.out / name / f"{method}_{count}", tuple(options),
                  cost=seconds * (1 + int(count) / 100))
             for label, seed, folder, name, options, seconds in places
             for method in settings.methods for count in settings.features]
    return cases, [sequence.folder for sequence in sequences]


def main(words: list[str]) -> int:
    """python3 -m bench tracking."""
    options = parser("tracking", DESCRIPTION, EXAMPLES)
    add_scenes(options, targets.TRACKING_SCENES)
    add_recordings(options)
    add_tracking_options(options)
    options.add_argument("--draw-every", metavar="S", help="draw the tracks every S seconds, in runs not timed")
    add_common(options, "out/bench_tracking")
    arguments = options.parse_intermixed_args(words)
    settings = settings_of(arguments)
    bench = bench_of(arguments, "tracking", words, targets.TRACKING_SCENES)

    cases, sequences = cases_of(bench, settings)
    track_all(bench, settings, cases)
    draw_all(bench, settings, cases)
    judge_all(bench, cases)

    rows = [row_of(case, bench.threads, settings.repeats) for case in cases]
    medians = summarize(rows)
    write_csv(bench.out / "tracking.csv", COLUMNS, rows)
    write_csv(bench.out / "tracking_medians.csv", ["scene", "seeds", *COLUMNS[2:-1], "failures"], medians)
    both, in_docs = sections(rows, medians)
    return report(bench, Outcome("tracking", both, target_rows(medians), [case.results for case in cases], sequences,
                                 in_docs=in_docs, failed=any(row["failure"] for row in rows)))
