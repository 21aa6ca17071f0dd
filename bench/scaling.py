"""How time and memory of the tracker grow with events, features and length."""
from __future__ import annotations

from dataclasses import replace

from bench import targets
from bench.files import Row, read_text, write_csv, write_text
from bench.measures import failure_of
from bench.options import Bench, add_common, add_scenes, bench_of, parser
from bench.plots import Line, plot_lines
from bench.record import Outcome, Section, report
from bench.runner import do
from bench.scenes import Part, Scene, Sequence, parse_scene
from bench.tables import Column
from bench.tracking import Settings, add_tracking_options, settings_of, track_all
from bench.tracking_table import SPEED_COLUMNS, Case, speed_cells

DESCRIPTION = """\
Measures time and memory of `evo-run track` on one scene (the first) and seed (the first). The tables go to stdout and
OUT/scaling.md, the numbers to OUT/scaling_*.csv, plots to OUT/scaling_*.svg:
  events     its first half, with 1, 0.6 and 0.35 of the scene's thresholds: about 1, 2 and 4 times the events
  features   50, 100, 200, 300, 450 and 600 instead of --features, down to 4 px apart, which makes room for them
  length     a quarter, a half and all of it; with --long also 75, 150, 300 and 600 s of a slow drive"""
EXAMPLES = """\
examples:
  python3 -m bench scaling --methods em --features 100
  python3 -m bench scaling --seeds 2 --long driving_night:20+8"""
SHARES = [0.6, 0.35]  # of the thresholds: about 2 and 4 times the events
COUNTS = ["50", "100", "200", "300", "450", "600"]
SPACING = ("--set", f"{targets.CORNER_SPACING}=4")
SLOW_SECONDS = ["75", "150", "300", "600"]
COLUMNS = ["sequence", "method", "features", "threads", "repeats", *SPEED_COLUMNS, "failure"]
TABLE = [
    Column("sequence", "sequence"),
    Column("method", "method"),
    Column("live features asked", "features", "d"),
    Column("mean", "mean_live_features", ".1f", meaning="Mean number of live features."),
    Column("recorded, s", "recorded_s", ".1f", meaning="Time that was tracked."),
    Column("Mev/s", "events_per_s", ".3f", 1e-6, "Million events in a second."),
    Column("wall s/s", "wall_s_per_recorded_s", ".3f", meaning="Wall time for a recorded second."),
    Column("CPU s/s", "cpu_s_per_recorded_s", ".3f", meaning="Processor time for a recorded second."),
    Column("peak memory, MB", "peak_memory_mb", ".1f", meaning="Largest resident memory of the process."),
    Column("failure", "failure"),
]
LABELS = {"wall_s_per_recorded_s": "wall time, s a recorded s", "cpu_s_per_recorded_s": "CPU time, s a recorded s",
          "peak_memory_mb": "peak memory, MB"}
# table: title, its x axis (column, factor, label), its y axes
TABLES = {
    "events": ("Time against events", "events_per_s", 1e-6, "million events a second",
               ["wall_s_per_recorded_s", "cpu_s_per_recorded_s"]),
    "features": ("Time against features", "mean_live_features", 1.0, "live features",
                 ["wall_s_per_recorded_s", "cpu_s_per_recorded_s"]),
    "length": ("Memory against length", "recorded_s", 1.0, "recorded s", ["peak_memory_mb"]),
}


def cases_of(bench: Bench, settings: Settings, what: str, sequence: Sequence, seconds: str, features: list[str],
             options: tuple[str, ...] = ()) -> list[Case]:
    """The cases of the first SECONDS of a sequence."""
    name = sequence.folder.relative_to(bench.sequences)
    folder = bench.out / "scaling" / what / name
    return [Case(str(name), sequence.seed, method, int(count), sequence.folder,
                 folder / f"{method}_{count}_{seconds}", ("--to", seconds, *options),
                 cost=float(seconds) * (1 + int(count) / 100))
            for method in settings.methods for count in features]


def part_of(seconds: str, share: float) -> str:
    """A share of a length."""
    return f"{float(seconds) * share:.9g}"


def sequences_of_events(bench: Bench, scene: Scene, seed: str, part: Part) -> list[Sequence]:
    """The first half with the scene's thresholds and with lower ones."""
    half = replace(scene, part=Part(part.start, part_of(part.seconds, 0.5)))
    parameters = bench.simulator().parameters(half, seed)
    sequences = [bench.simulator().sequence(half, seed)]
    for share in SHARES:
        lowered = tuple(f"{name}={float(parameters[name]) * share:.9g}" for name in targets.THRESHOLDS)
        sequences.append(bench.simulator(lowered, f"thresholds_{share:g}").sequence(half, seed))
    return sequences


def slow_drive(bench: Bench, seed: str) -> Sequence:
    """10 minutes of few events, which need little disk."""
    simulator = bench.simulator(tuple(targets.SLOW_DRIVE), "slow")
    return simulator.sequence(parse_scene("driving_day:600"), seed)


def track_slow_drive(bench: Bench, settings: Settings, seed: str) -> list[Case]:
    """Memory over the slow drive, which is deleted at the end but for what tells that the results are still its own."""
    sequence = slow_drive(bench, seed)
    cases = [case for seconds in SLOW_SECONDS
             for case in cases_of(bench, settings, "length", sequence, seconds, settings.features[:1])]
    done = bench.out / "scaling" / "length" / "slow.txt"
    key = f"{bench.program.checksum} {bench.threads} {settings}\n{sequence.made_from}"
    if not sequence.is_made() or read_text(done) != key:
        do(bench.simulator(tuple(targets.SLOW_DRIVE), "slow").missing([sequence]))
    track_all(bench, settings, cases)
    write_text(done, key)
    sequence.delete_events()
    return cases


def row_of(bench: Bench, settings: Settings, case: Case) -> Row:
    """The row of a case."""
    return {"sequence": case.label, "method": case.method, "features": case.features, "threads": bench.threads,
            "repeats": settings.repeats, **speed_cells(case.results), "failure": failure_of(case.results)}


def plot(bench: Bench, name: str, rows: list[Row]) -> list[str]:
    """Draws a table: a line for each method and, unless that is varied, number of features, the slow drive apart."""
    _, x, factor, label, axes = TABLES[name]
    panels = []
    for y in axes:
        lines: dict[str, list[tuple[float, float]]] = {}
        for row in rows:
            if row.get(x) is None:
                continue
            title = ("slow drive, " if str(row["sequence"]).startswith("slow") else "") + str(row["method"])
            title += "" if name == "features" else f", {row['features']} features"
            lines.setdefault(title, []).append((factor * row[x], row[y]))  # type: ignore[operator, arg-type]
        panels.append((LABELS[y], list[Line](lines.items())))
    return plot_lines(bench.out, f"scaling_{name}", label, panels)


def measure(bench: Bench, settings: Settings, long: bool) -> dict[str, list[Case]]:
    """Tracks all that is missing."""
    scene, seed = bench.scenes[0], bench.seeds[0]
    whole = bench.simulator().sequence(scene, seed)
    seconds = whole.part.seconds
    by_events = sequences_of_events(bench, scene, seed, whole.part)
    do(bench.simulator().missing([whole, by_events[0]]), bench.jobs)
    for share, sequence in zip(SHARES, by_events[1:]):
        do(bench.simulator(subfolder=f"thresholds_{share:g}").missing([sequence]))
    half = by_events[0].part.seconds
    cases = {
        "events": [case for sequence in by_events
                   for case in cases_of(bench, settings, "events", sequence, half, settings.features)],
        "features": cases_of(bench, settings, "features", whole, seconds, COUNTS, SPACING),
        "length": [case for share in (0.25, 0.5, 1.0)
                   for case in cases_of(bench, settings, "length", whole, part_of(seconds, share), settings.features)],
    }
    for group in cases.values():
        track_all(bench, settings, group)
    if long:
        cases["length"] += track_slow_drive(bench, settings, seed)
    return cases


def main(words: list[str]) -> int:
    """python3 -m bench scaling."""
    options = parser("scaling", DESCRIPTION, EXAMPLES)
    add_scenes(options, targets.TRACKING_SCENES[:1])
    add_tracking_options(options)
    options.add_argument("--long", action="store_true",
                         help="memory over 10 minutes, too; simulating them takes 10 to 30 minutes and 300 MB, "
                              "which are deleted afterwards")
    add_common(options, "out/bench_tracking")
    arguments = options.parse_intermixed_args(words)
    settings = settings_of(arguments)
    bench = bench_of(arguments, "scaling", words, targets.TRACKING_SCENES[:1])
    bench.scenes, bench.seeds = bench.scenes[:1], bench.seeds[:1]

    cases = measure(bench, settings, arguments.long)
    outcome = Outcome("scaling", [])
    for name, group in cases.items():
        rows = [row_of(bench, settings, case) for case in group]
        write_csv(bench.out / f"scaling_{name}.csv", COLUMNS, rows)
        failed = any(row["failure"] for row in rows)
        outcome.sections.append(Section(TABLES[name][0], TABLE if failed else TABLE[:-1], rows))
        outcome.results += [case.results for case in group]
        outcome.figures += plot(bench, name, rows)
        outcome.failed |= failed
    return report(bench, outcome)
