"""Rows, medians and targets of the tracking benchmark."""
from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Sequence

from bench.files import Row, Value, read_csv
from bench.measures import Manifest, Quantities, failure_of, number, ratio
from bench.record import Section
from bench.tables import Column, group_rows, median
from bench.targets import TRACKING_TARGETS, Target, scene_name, verdict

LARGE_AGE_PX = 5.0  # a track is alive as long as its error is below
LARGE_ERROR_PX = 3.0  # tracks over it are counted
CLOSE_FEATURES = 0.15  # about so many features: relative difference of the mean number alive


@dataclass(frozen=True)
class Case:
    """A recording tracked with a method and a number of features."""

    label: str
    seed: str
    method: str
    features: int
    folder: Path
    results: Path
    options: tuple[str, ...] = ()
    cost: float = 1.0


SPEED_COLUMNS = ["recorded_s", "events_per_s", "mean_live_features", "real_time_factor_median",
                 "real_time_factor_best", "wall_s_per_recorded_s", "cpu_s_per_recorded_s", "peak_memory_mb"]
TEXT_COLUMNS = ["scene", "method", "truth"]
COLUMNS = ["scene", "seed", "method", "features", "threads", "repeats", *SPEED_COLUMNS, "truth", "tracks_judged",
           "track_error_median_px", "track_error_to_5_px_median_px", "expected_age_at_5_px_share",
           "expected_age_at_5_px_s", "tracks_over_3_px_share", "tracks_mostly_over_3_px_share",
           "tracks_astray_over_3_px_share", "positions_past_3_px_share", "tracks_that_move_share",
           "triangulation_residual_median_px", "lifetime_frames", "lifetime_s", "frame_interval_s", "failure"]
TABLE = [
    Column("live features asked", "features", "d"),
    Column("mean", "mean_live_features", ".1f", meaning="Mean number of live features."),
    Column("x real time", "real_time_factor_median",
           meaning="Recorded time over wall time of reading, tracking and writing, median over the repetitions."),
    Column("best", "real_time_factor_best", meaning="The same of the fastest repetition."),
    Column("CPU s/s", "cpu_s_per_recorded_s", meaning="Processor time of the whole process for a recorded second."),
    Column("error, px", "track_error_median_px",
           meaning="Median over the tracks of each track's median distance from the truth over its whole life."),
    Column("error to 5 px", "track_error_to_5_px_median_px",
           meaning="The same up to a track's first error over 5 px."),
    Column("age to 5 px, %", "expected_age_at_5_px_share", ".1f", 100,
           "Time that a track stays within 5 px, as a percentage of the time that its point is visible."),
    Column("age, s", "expected_age_at_5_px_s", meaning="The same in seconds."),
    Column("over 3 px ever, %", "tracks_over_3_px_share", ".1f", 100, "Tracks that ever err by more than 3 px."),
    Column("mostly", "tracks_mostly_over_3_px_share", ".1f", 100, "Tracks whose median error exceeds 3 px."),
    Column("astray", "tracks_astray_over_3_px_share", ".1f", 100,
           "Tracks whose median error exceeds 3 px from every surface within 3 px of where they began."),
    Column("positions", "positions_past_3_px_share", ".1f", 100,
           "Positions from a track's first error over 3 px on."),
    Column("tracks judged", "tracks_judged", "d", meaning="Tracks with a truth, none on or beside moving objects."),
    Column("residual, px", "triangulation_residual_median_px",
           meaning="Median residual of tracks triangulated with the true poses, where there are no depth maps."),
    Column("lifetime, frames", "lifetime_frames", ".1f", meaning="Mean lifetime of tracks of at least 3 frames."),
    Column("lifetime, s", "lifetime_s", meaning="The same in seconds."),
    Column("frame, s", "frame_interval_s", ".3f", meaning="Time between two frames."),
]


def speed_cells(results: Path) -> dict[str, Value]:
    """Speed and memory of a case; nothing where it failed."""
    manifest = Manifest(results / "manifest.json")
    if not manifest.exists:
        return {}
    times = read_csv(results / "times.csv")
    recorded = manifest.value("recorded_s")
    walls = [number(row["wall_s"]) for row in times]
    wall = median(walls)
    best = min((value for value in walls if value is not None), default=None)
    return {
        "recorded_s": recorded,
        "events_per_s": ratio(manifest.count("events"), recorded),
        "mean_live_features": ratio(manifest.count("track_observations"), manifest.count("event_frames")),
        "real_time_factor_median": ratio(recorded, wall),
        "real_time_factor_best": ratio(recorded, best),
        "wall_s_per_recorded_s": ratio(wall, recorded),
        "cpu_s_per_recorded_s": ratio(median(number(row["cpu_s"]) for row in times), recorded),
        "peak_memory_mb": median(number(row["peak_memory_mb"]) for row in times),
    }


def accuracy_cells(quality: Quantities) -> dict[str, Value]:
    """Errors and ages of the tracks; triangulation tells a residual only."""
    truth, error = quality.text("truth", "name"), quality.number("track_error_median", "px")
    cells: dict[str, Value] = {"truth": truth, "tracks_judged": quality.number("tracks_judged", "count")}
    if truth == "triangulated":
        return {**cells, "triangulation_residual_median_px": error}
    part = ratio(quality.number("compared_positions", "count", LARGE_ERROR_PX),
                 quality.number("compared_positions", "count"))
    return {
        **cells,
        "track_error_median_px": error,
        "track_error_to_5_px_median_px": quality.number("track_error_median", "px", LARGE_AGE_PX),
        "expected_age_at_5_px_share": quality.number("expected_feature_age_normalized", "share", LARGE_AGE_PX),
        "expected_age_at_5_px_s": quality.number("expected_feature_age", "s", LARGE_AGE_PX),
        "tracks_over_3_px_share": quality.number("exceeding_share", "share", LARGE_ERROR_PX),
        "tracks_mostly_over_3_px_share": quality.number("mostly_exceeding_share", "share", LARGE_ERROR_PX),
        "tracks_astray_over_3_px_share": quality.number("stray_share", "share", LARGE_ERROR_PX),
        "positions_past_3_px_share": None if part is None else 1 - part,
        "tracks_that_move_share": ratio(quality.number("tracks_moves", "count"), quality.number("tracks", "count")),
    }


def row_of(case: Case, threads: int, repeats: int) -> Row:
    """The row of a case."""
    lifetime = Quantities(case.results / "lifetime.csv")
    return {
        "scene": case.label, "seed": case.seed, "method": case.method, "features": case.features,
        "threads": threads, "repeats": repeats,
        **speed_cells(case.results),
        **accuracy_cells(Quantities(case.results / "track_quality" / "track_quality.csv")),
        "lifetime_frames": lifetime.number("mean", "frames"),
        "lifetime_s": lifetime.number("mean", "s"),
        "frame_interval_s": lifetime.number("frame_interval", "s"),
        "failure": failure_of(case.results),
    }


def summarize(rows: Sequence[Row]) -> list[Row]:
    """For each scene, method and number of features the medians over the seeds."""
    summary = []
    for group in group_rows(rows, lambda row: (row["scene"], row["method"], row["features"])):
        medians: dict[str, Value] = {"seeds": len(group), "failures": sum(1 for row in group if row["failure"])}
        for column in COLUMNS[:-1]:
            if column in TEXT_COLUMNS:
                medians[column] = next((row[column] for row in group if row.get(column)), None)
            elif column != "seed":
                medians[column] = median(row.get(column) for row in group)
        summary.append(medians)
    return summary


def sections(rows: Sequence[Row], medians: Sequence[Row]) -> tuple[list[Section], list[Section]]:
    """The tables for stdout, and for docs/benchmarks.md."""
    first, scene, method = Column("failure", "failure"), Column("scene", "scene"), Column("method", "method")
    tail = [first] if any(row["failure"] for row in rows) else []
    each = Section("Tracks", [scene, Column("seed", "seed"), method, *TABLE, *tail], rows)
    count = Column("failed", "failures", "d", meaning="Runs that failed.")
    middle = Section("Medians over the seeds",
                     [scene, Column("seeds", "seeds", "d"), method, *TABLE, *([count] if tail else [])], medians)
    return [each, middle], [middle]


def target_rows(medians: Sequence[Row]) -> list[Row]:
    """The targets of the EM tracker on the scenes that were measured."""
    by_case = {(row["scene"], row["method"], row["features"]): row for row in medians}
    return [target_row(target, row, by_case.get((row["scene"], "klt", row["features"]), {}))
            for row in medians if row["method"] == "em"
            for target in TRACKING_TARGETS
            if target.scene == scene_name(str(row["scene"])) and applies(target, row)]


def applies(target: Target, row: Row) -> bool:
    """Whether a target is for the number of features asked for, or for about as many as are alive."""
    if target.features in (0, row["features"]):
        return True
    live = row.get("mean_live_features")
    return live is not None and abs(float(live) - target.features) <= CLOSE_FEATURES * target.features


def target_row(target: Target, em: Row, klt: Row) -> Row:
    """A target beside what was measured."""
    ratios = {"age_share_over_klts": "expected_age_at_5_px_share", "age_s_over_klts": "expected_age_at_5_px_s"}
    if target.quantity in ratios:
        column = ratios[target.quantity]
        value = ratio(em.get(column), klt.get(column))  # type: ignore[arg-type]
    else:
        found = em.get(target.quantity)
        value = None if found is None else target.factor * float(found)
    result = verdict(value, target.comparison, target.limit)
    live = em.get("mean_live_features")
    if target.features and live is not None and float(live) < 0.9 * target.features:
        result += f", with {float(live):.0f} alive"
    quantity = target.quantity
    if target.factor == 100:
        quantity = quantity.removesuffix("_share") + "_percent"
    return {"scene": em["scene"], "configuration": f"em, {round(float(em['features'] or 0))} features", "of": "median",
            "quantity": quantity, "target": f"{target.comparison} {target.limit:g}", "measured": value,
            "result": result}
