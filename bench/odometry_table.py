"""Rows, summary and targets of the odometry benchmark."""
from __future__ import annotations

from pathlib import Path
from typing import Mapping, Sequence

from bench.bumps import bump_cells
from bench.files import Row, Value
from bench.measures import (Manifest, Summary, coverage_since_start, failure_of, ratio, rotation_drift_deg_per_m,
                            track_duration_s)
from bench.record import Section
from bench.tables import Column, SpreadColumn, group_rows, median, worst
from bench.targets import (MORE_FEATURES, ODOMETRY_TARGETS, OTHER_SCENE, PUBLISHED_COMPARES_WITH, PUBLISHED_ODOMETRY,
                           Target, scene_name, verdict)

BUMP_COLUMNS = ["error_before_bump_percent", "error_after_bump_percent", "bump_growth",
                "own_scale_error_before_bump_percent", "own_scale_error_after_bump_percent", "own_scale_bump_growth"]
QUANTITIES = ["recorded_s", "path_m", "coverage_share", "coverage_since_start_share", "rebootstraps", "frames_lost",
              "mean_planar_percent", "max_planar_percent", "sim3_mean_planar_percent", "sim3_max_planar_percent",
              "sim3_ape_rmse_percent", "rotation_deg_per_m", *BUMP_COLUMNS, "nees_translation", "nees_rotation",
              "nees_pose", "run_x_real_time", "odometry_x_real_time", "cpu_s", "mean_longitudinal_m",
              "mean_lateral_m", "mean_planar_m"]
COLUMNS = ["scene", "seed", "config", *QUANTITIES, "failure"]
SUMMARY_COLUMNS = ["scene", "config", "seeds", "failures"] + [f"{name}_{kind}" for name in QUANTITIES
                                                              for kind in ("median", "worst")]
TABLE = [
    Column("", "config"),
    SpreadColumn("covered, %", "coverage_since_start_share", ".1f", 100,
                 "Share of the time since the first pose that has poses."),
    SpreadColumn("reinitialised", "rebootstraps", "d", meaning="Times that the map was started again."),
    SpreadColumn("origin-scale: mean planar, %", "mean_planar_percent", ".3g",
                 meaning="Mean planar error in % of the path, with the first pose and one scale from the truth."),
    SpreadColumn("largest", "max_planar_percent", ".3g", meaning="Largest planar error, in % of the path."),
    SpreadColumn("sim3: mean planar, %", "sim3_mean_planar_percent", ".3g",
                 meaning="Mean planar error after the best similarity; none where a straight line does not determine it."),
    SpreadColumn("sim3: largest", "sim3_max_planar_percent", ".3g", meaning="Largest planar error after it."),
    SpreadColumn("rotation, deg/100 m", "rotation_deg_per_m", ".3g", 100,
                 "Drift of the rotation over half of the path."),
    SpreadColumn("over a bump", "bump_growth",
                 meaning="Error over 5 m in the 5 s after the first bump over that in the 5 s before, scale of the run."),
    SpreadColumn("with its own scale", "own_scale_bump_growth", meaning="The same with a scale for each 5 s."),
    SpreadColumn("errors over covariance", "nees_pose",
                 meaning="Squared pose errors over their covariances for one degree of freedom: 1 is honest."),
    SpreadColumn("run, x real time", "run_x_real_time", ".1f",
                 meaning="Recorded time over wall time of tracking and odometry."),
    SpreadColumn("odometry, x real time", "odometry_x_real_time", ".1f", meaning="The same of the odometry alone."),
]


def row_of(label: str, seed: str, config: str, results: Path, folder: Path) -> Row:
    """The row of a run."""
    judged = results / "judged" if (results / "judged").exists() else results
    manifest, summary = Manifest(results / "manifest.json"), Summary(judged / "summary.csv")
    tracks = results / "tracks.txt" if (results / "tracks.txt").exists() else folder / "tracks.txt"
    recorded = manifest.value("recorded_s")
    if recorded is None and (folder / "tracks.txt").exists():
        recorded = track_duration_s(folder / "tracks.txt")
    track, odometry = manifest.stage_s("track"), manifest.stage_s("odometry")
    row: dict[str, Value] = {
        "scene": label, "seed": seed, "config": config, "recorded_s": recorded,
        "coverage_share": summary.number("origin-scale", "coverage"),
        "coverage_since_start_share": coverage_since_start(results / "trajectory.txt", tracks),
        "rebootstraps": manifest.rebootstraps(), "frames_lost": manifest.count("frames_lost"),
        "sim3_mean_planar_percent": summary.number("sim3", "mean_planar_percent"),
        "sim3_max_planar_percent": summary.number("sim3", "max_planar_percent"),
        "sim3_ape_rmse_percent": ratio(summary.number("sim3", "ape_rmse_m"), summary.number("sim3", "path_m"), 100),
        "rotation_deg_per_m": rotation_drift_deg_per_m(judged / "metrics.csv"),
        **bump_cells(results),
        "run_x_real_time": None if track is None else ratio(recorded, track + (odometry or 0.0)),
        "odometry_x_real_time": ratio(recorded, odometry),
        "cpu_s": manifest.value("cpu_time_s"), "failure": failure_of(results),
        "mean_longitudinal_m": summary.number("origin-scale", "mean_abs_longitudinal_m"),
        "mean_lateral_m": summary.number("origin-scale", "mean_abs_lateral_m"),
    }
    for column in ("path_m", "mean_planar_percent", "max_planar_percent", "mean_planar_m", "nees_translation",
                   "nees_rotation", "nees_pose"):
        row[column] = summary.number("origin-scale", column)
    return row


def more_is_better(column: str) -> bool:
    """Whether the worst of a column is its least."""
    return column.startswith(("coverage", "recorded", "path")) or column.endswith("_x_real_time")


def summarize(rows: Sequence[Row]) -> list[Row]:
    """For each scene and configuration the median over the seeds and the worst of each quantity."""
    summary = []
    for group in group_rows(rows, lambda row: (row["scene"], row["config"])):
        cells: dict[str, Value] = {"scene": group[0]["scene"], "config": group[0]["config"], "seeds": len(group),
                                   "failures": sum(1 for row in group if row["failure"])}
        for name in QUANTITIES:
            cells[f"{name}_median"] = median(row[name] for row in group)
            cells[f"{name}_worst"] = worst((row[name] for row in group), more_is_better(name))
        summary.append(cells)
    return summary


def sections(summary: Sequence[Row]) -> list[Section]:
    """A table for each scene, a row for each configuration."""
    found = []
    failed = [Column("failed", "failures", "d")] if any(row["failures"] for row in summary) else []
    for group in group_rows(summary, lambda row: (row["scene"],)):
        seeds = int(group[0]["seeds"] or 0)
        runs = f"{seeds} seeds: median (worst)" if seeds > 1 else "1 run"
        sizes = [f"{float(value):.3g} {unit}" for value, unit in
                 ((group[0]["recorded_s_median"], "s"), (group[0]["path_m_median"], "m")) if value is not None]
        found.append(Section(", ".join([str(group[0]["scene"]), runs, *sizes]), [*TABLE, *failed], group))
    return found


def published_section(summary: Sequence[Row]) -> Section | None:
    """The paper's table 3 beside ours on the drive that is like its sequence."""
    ours = [row for row in summary if row["scene"] == PUBLISHED_COMPARES_WITH]
    if not ours:
        return None
    rows: list[dict[str, Value]] = [{"config": "the paper, on MVSEC outdoor_day2", "seeds": "", **PUBLISHED_ODOMETRY}]
    rows += [{"config": f"{row['config']}, {row['scene']}", "seeds": row["seeds"],
              **{name: row[f"{name}_median"] for name in PUBLISHED_ODOMETRY}} for row in ours]
    columns = [Column("", "config"), Column("seeds", "seeds", "d"),
               Column("longitudinal, m", "mean_longitudinal_m", ".3f", meaning="Mean error along the direction of travel."),
               Column("lateral, m", "mean_lateral_m", ".3f", meaning="Mean error to the side."),
               Column("planar, m", "mean_planar_m", ".3f", meaning="Mean length of both."),
               Column("planar, %", "mean_planar_percent", ".3f", meaning="The same in % of the path."),
               Column("largest, %", "max_planar_percent", ".3f",
                      meaning='Largest planar error in % of the path, the paper\'s "relative error".')]
    return Section("Beside the paper's table 3 (origin-scale, medians over the seeds)", columns, rows)


def target_rows(summary: Sequence[Row], ours: str) -> list[Row]:
    """The targets of the scenes that were measured."""
    by_case = {(str(row["scene"]), str(row["config"])): row for row in summary}
    scenes = list(dict.fromkeys(str(row["scene"]) for row in summary))
    return [target_row(target, scene, ours, by_case) for scene in scenes for target in ODOMETRY_TARGETS
            if target.scene in (scene, scene_name(scene))]


def target_row(target: Target, scene: str, ours: str, by_case: Mapping[tuple[str, str], Row]) -> Row:
    """A target beside what was measured."""
    config = MORE_FEATURES if target.features else ours
    row = by_case.get((scene, config), {})
    if target.quantity in OTHER_SCENE:
        other = by_case.get((OTHER_SCENE[target.quantity] + scene[len(scene_name(scene)):], config), {})
        value = ratio(row.get("mean_planar_percent_median"),  # type: ignore[arg-type]
                      other.get("mean_planar_percent_median"))  # type: ignore[arg-type]
    else:
        found = row.get(f"{target.quantity}_{target.of}")
        value = None if found is None else float(found)
    result = verdict(value, target.comparison, target.limit)
    if result == "met" and target.stretch is not None and verdict(value, target.comparison, target.stretch) == "met":
        result = "met, stretch too"
    if row.get("failures"):
        result = f"missed: {row['failures']} of {row['seeds']} failed"
    return {"scene": scene, "configuration": config, "quantity": target.quantity, "of": target.of,
            "target": f"{target.comparison} {target.limit:g}", "measured": value, "result": result,
            "stretch": None if target.stretch is None else f"{target.stretch:g}"}
