"""What simulated sequences are like, what they cost, and how well they are tracked and followed."""
from __future__ import annotations

from pathlib import Path

from bench.files import Row, write_csv
from bench.measures import Manifest, Quantities, Summary, failure_of, ratio
from bench.options import Bench, add_common, add_scenes, bench_of, list_of, name_value, parser
from bench.program import CONFIGS
from bench.recordings import calibration_of, ground_truth_of
from bench.record import Outcome, Section, report
from bench.runner import Job, do, identity, is_done, key_of, mark_done, run_into
from bench.scenes import Sequence, Simulator, simulated_by
from bench.tables import Column, SpreadColumn, group_rows, median, worst
from bench.tracking import judge_tracks

DESCRIPTION = """\
Simulates scenes, runs evo-run on each and prints one table: what the sequence is like, what it cost to make, and how
well it is tracked and followed. The table goes to stdout and OUT/scenes.md, the numbers to OUT/scenes.csv and
OUT/scenes_summary.csv, all plots to OUT/report/index.html. Sequences stay in SEQUENCES/SCENE_SEED_PART, in MVSEC's
layout for vehicles and UZH's for the others. Without [FROM+]SECONDS drives begin at the scene's start and end as
--duration says; other scenes last as long as their file says. Sequences are kept as long as the scene's parameters
are the same; --resimulate is needed where the simulator itself has changed."""
EXAMPLES = """\
examples:
  python3 -m bench scenes
  python3 -m bench scenes --seeds 1,2,3 driving_night:20 driving_day:50+8
  python3 -m bench scenes --out out/300 --set tracker.features=300 driving_day
  python3 -m bench scenes --simulate-set sensor.threshold_on=0.3 --sequences out/sharp --out out/bench_sharp
  python3 -m bench scenes --simulate-only --seeds 1,2 turns     # only makes out/scenes/turns_1_8 and turns_2_8"""
COLUMNS = ["scene", "seed", "simulated_s", "path_m", "events", "negative_per_positive", "simulate_wall_s",
           "simulate_cpu_s", "simulate_peak_memory_mb", "coverage", "rebootstraps", "mean_planar_percent",
           "max_planar_percent", "sim3_mean_planar_percent", "sim3_max_planar_percent", "lifetime_frames",
           "lifetime_s", "track_error_median_px", "expected_feature_age_share", "speed_x_real_time", "run_cpu_s",
           "failure"]
# Derived for reading: rates and costs for each simulated second.
RATES = {"events_per_s": "events", "simulate_wall_per_s": "simulate_wall_s", "simulate_cpu_per_s": "simulate_cpu_s",
         "run_cpu_per_s": "run_cpu_s"}
MORE_IS_BETTER = ("coverage", "lifetime_frames", "lifetime_s", "expected_feature_age_share", "speed_x_real_time")
SPREAD = [
    ("Mev/s", "events_per_s", ".2f", 1e-6, "Million events in a simulated second."),
    ("neg. : pos.", "negative_per_positive", ".2f", 1.0, "Negative events for each positive one."),
    ("simulate: wall s/s", "simulate_wall_per_s", ".1f", 1.0, "Wall time to simulate a second, if made alone."),
    ("CPU s/s", "simulate_cpu_per_s", ".1f", 1.0, "Processor time to simulate a second."),
    ("MB", "simulate_peak_memory_mb", ".0f", 1.0, "Largest resident memory of the simulation."),
    ("covered, %", "coverage", ".1f", 100.0, "Share of the time with poses."),
    ("reinitialised", "rebootstraps", "d", 1.0, "Times that the map was started again."),
    ("planar mean, %", "mean_planar_percent", ".2f", 1.0, "Mean planar error, first pose and one scale from the truth."),
    ("largest, %", "max_planar_percent", ".2f", 1.0, "Largest planar error, in % of the path."),
    ("sim3 mean, %", "sim3_mean_planar_percent", ".2f", 1.0, "Mean planar error after the best similarity."),
    ("sim3 largest, %", "sim3_max_planar_percent", ".2f", 1.0, "Largest planar error after it."),
    ("lifetime, frames", "lifetime_frames", ".1f", 1.0, "Mean lifetime of tracks of at least 3 frames."),
    ("lifetime, s", "lifetime_s", ".2f", 1.0, "The same in seconds."),
    ("track error, px", "track_error_median_px", ".2f", 1.0, "Median over the tracks of their median error, to 5 px."),
    ("age, %", "expected_feature_age_share", ".0f", 100.0, "Expected feature age over 1 to 31 px, of the visible time."),
    ("x real time", "speed_x_real_time", ".2f", 1.0, "Recorded time over wall time of tracking and odometry."),
    ("run CPU s/s", "run_cpu_per_s", ".2f", 1.0, "Processor time of `run` for a simulated second."),
]


def run_and_judge(bench: Bench, settings: list[str], sequence: Sequence, key: str) -> None:
    """Runs and judges a sequence."""
    results = bench.out / sequence.name
    run_into(results, bench.program, ["run", "--events", str(sequence.folder), "--threads", str(bench.threads),
                                      *settings])
    truth, calibration = ground_truth_of(sequence.folder), calibration_of(sequence.folder)
    if (results / "tracks.txt").exists() and truth and calibration:
        judge_tracks(bench, results, truth, calibration, [])
    mark_done(results, key)


def row_of(bench: Bench, sequence: Sequence) -> Row:
    """The row of a sequence."""
    results = bench.out / sequence.name
    made, run = Manifest(sequence.folder / "manifest.json"), Manifest(results / "manifest.json")
    summary = Summary(results / "summary.csv")
    lifetime = Quantities(results / "lifetime.csv")
    quality = Quantities(results / "track_quality" / "track_quality.csv")
    events, positive = made.count("events"), made.count("positive_events")
    alone = simulated_by(sequence.folder).get("at_a_time", 1) == 1
    spent = (run.stage_s("track") or 0.0) + (run.stage_s("odometry") or 0.0)
    row: dict = {
        "scene": sequence.scene.name, "part": str(sequence.part), "seed": sequence.seed,
        "simulated_s": float(sequence.part.seconds), "events": events,
        "negative_per_positive": None if events is None or positive is None else ratio(events - positive, positive),
        "simulate_wall_s": made.stage_s("simulate") if alone else None,
        "simulate_cpu_s": made.value("cpu_time_s"), "simulate_peak_memory_mb": made.value("peak_memory_mb"),
        "lifetime_frames": lifetime.number("mean", "frames"), "lifetime_s": lifetime.number("mean", "s"),
        "track_error_median_px": quality.number("track_error_median", "px", 5.0),
        "expected_feature_age_share": quality.number("expected_feature_age_normalized_1_to_31_px", "share"),
        "speed_x_real_time": ratio(run.value("recorded_s"), spent), "run_cpu_s": run.value("cpu_time_s"),
        "failure": failure_of(results),
    }
    for column in ("path_m", "coverage", "rebootstraps", "mean_planar_percent", "max_planar_percent"):
        row[column] = summary.number("origin-scale", column)
    for column in ("mean_planar_percent", "max_planar_percent"):
        row[f"sim3_{column}"] = summary.number("sim3", column)
    for rate, column in RATES.items():
        row[rate] = ratio(row[column], row["simulated_s"])
    return row


def summarize(rows: list[Row]) -> list[Row]:
    """For each scene and part the median over the seeds and the worst of each quantity."""
    summary = []
    for group in group_rows(rows, lambda row: (row["scene"], row["part"])):
        cells: dict = {"scene": f"{group[0]['scene']}:{group[0]['part']}", "seeds": len(group),
                       "failures": sum(1 for row in group if row["failure"])}
        for key in [column[1] for column in SPREAD]:
            cells[f"{key}_median"] = median(row[key] for row in group)
            cells[f"{key}_worst"] = worst((row[key] for row in group), key in MORE_IS_BETTER)
        summary.append(cells)
    return summary


def measure(bench: Bench, simulator: Simulator, settings: list[str], sequences: list[Sequence], delete: bool,
            resimulate: bool) -> None:
    """Simulates, runs and judges what is missing; with `delete` one sequence after the other."""
    def key(sequence: Sequence) -> str:
        return key_of(bench.program, settings, f"threads {bench.threads}", identity(sequence.folder))

    left = [item for item in sequences
            if resimulate or not item.is_made() or not is_done(bench.out / item.name, key(item))]
    if not delete:
        do(simulator.missing(left, resimulate), bench.jobs)
    for item in left:
        if delete:
            do(simulator.missing([item], resimulate))
        if not is_done(bench.out / item.name, key(item)):
            do([Job(f"run        {bench.out / item.name}",
                    lambda item=item: run_and_judge(bench, settings, item, key(item)))])
        if delete:
            item.delete_events()
    if delete:
        for item in sequences:
            item.delete_events()


def main(words: list[str]) -> int:
    """python3 -m bench scenes."""
    options = parser("scenes", DESCRIPTION, EXAMPLES)
    add_scenes(options, None)
    options.set_defaults(seeds=["1"])
    options.add_argument("--duration", type=list_of("[0-9.]+"), default=["8"], metavar="SECONDS",
                         help="of the drives; default 8")
    for name, command in (("--set", "run"), ("--simulate-set", "simulate")):
        options.add_argument(name, type=name_value, action="append", default=[], metavar="NAME=VALUE",
                             help=f"a parameter of `evo-run {command}`; may be repeated")
    options.add_argument("--simulate-only", action="store_true", help="no runs, no table; prints the sequences' folders")
    options.add_argument("--resimulate", "--anew", action="store_true", help="simulate all sequences again")
    options.add_argument("--delete", action="store_true",
                         help="delete each sequence after use: 5 to 20 MB for a second of it")
    add_common(options, "out/bench_scenes")
    arguments = options.parse_intermixed_args(words)
    every = sorted(str(path) for path in (CONFIGS / "scenes").glob("*.yaml") if path.stem != "random")
    bench = bench_of(arguments, "scenes", words, every)
    simulator = bench.simulator(tuple(arguments.simulate_set), drive_seconds=arguments.duration[0])
    sequences = [simulator.sequence(scene, seed) for scene in bench.scenes for seed in bench.seeds]
    if arguments.simulate_only:
        do(simulator.missing(sequences, arguments.resimulate), bench.jobs)
        print("\n".join(str(sequence.folder) for sequence in sequences))
        return 0
    settings = [word for setting in arguments.set for word in ("--set", setting)]
    measure(bench, simulator, settings, sequences, arguments.delete, arguments.resimulate)
    return finish(bench, sequences)


def finish(bench: Bench, sequences: list[Sequence]) -> int:
    """Writes the tables and the page of all runs."""
    rows = [row_of(bench, sequence) for sequence in sequences]
    summary = summarize(rows)
    results: list[Path] = [bench.out / sequence.name for sequence in sequences]
    write_csv(bench.out / "scenes.csv", COLUMNS, rows)
    write_csv(bench.out / "scenes_summary.csv", list(summary[0]), summary)
    bench.program.output("report", "--force", "--out", str(bench.out / "report"), "--title", "Simulated scenes",
                         *map(str, results))
    failed = any(row["failure"] for row in rows)
    tail = [Column("failure", "failure")] if failed else []
    each = [Column("scene", "scene"), Column("seed", "seed"), Column("simulated, s", "simulated_s", ".3g")]
    whole = [Column("scene", "scene"), Column("seeds", "seeds", "d")]
    first = Section("Scenes", [*each, *(Column(*column) for column in SPREAD), *tail], rows)
    second = Section("Scenes, medians over the seeds (worst)", [*whole, *(SpreadColumn(*c) for c in SPREAD)], summary)
    return report(bench, Outcome("scenes", [first], [], results, [item.folder for item in sequences],
                                 in_docs=[second], failed=failed))
