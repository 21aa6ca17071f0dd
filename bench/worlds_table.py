"""Rows, distributions and the worst drives of the random worlds."""
from __future__ import annotations

import re
from pathlib import Path
from typing import Sequence as List

from bench.files import Row, Value, read_text
from bench.measures import (Manifest, Summary, coverage_since_start, failure_of, ratio, resting_share)
from bench.record import Section
from bench.scenes import DRAWN_SCENE, Scene, Sequence, Simulator
from bench.tables import Column, median
from bench.targets import WORLD_TARGETS, verdict

LOST_BELOW = 0.97  # coverage since the first pose
# Quantity, title, digits, meaning.
QUANTITIES = [
    ("mean_planar_percent", "mean planar, %", ".3f",
     "Mean planar error in % of the path, with the first pose and one scale from the truth."),
    ("max_planar_percent", "largest planar, %", ".3f", "Largest planar error in % of the path."),
    ("kitti_translation_percent", "KITTI translation, %", ".2f", "KITTI's translation error; drives of 100 m and more."),
    ("kitti_rotation_deg_per_m", "KITTI rotation, deg/m", ".4f", "KITTI's rotation error; drives of 100 m and more."),
    ("final_vertical_percent", "vertical at the end, %", ".3f", "Vertical error at the end in % of the path."),
    ("metric_scale_error_percent", "metric scale, %", ".2f",
     "Error of the metric scale with the camera's height given; where the odometry claims one."),
    ("nees_pose", "nees", ".2f", "Squared pose errors over their covariances for one degree of freedom: 1 is honest."),
    ("resting_share", "at rest, %", ".1f",
     "Observations of tracks of 15 frames and more that move by less than 6 px/s."),
    ("run_x_real_time", "x real time", ".1f", "Recorded time over wall time of tracking and odometry."),
]
COLUMNS = ["seed", "method", "recorded_s", "path_m", "events", "lost", "coverage_since_start_share", "rebootstraps",
           "ground_tracks", "has_metric_scale", "metric_scale", *(name for name, *_ in QUANTITIES), "failure"]
# Drawn parameters that the table of the worst drives shows, and their titles.
PROPERTIES = [("motion.vehicle.speed_m_s", "m/s"), ("camera.width_px", "px"), ("sensor.threshold_off", "threshold off"),
              ("sensor.threshold_on", "on"), ("sensor.shot_noise_hz", "noise, Hz"), ("sensor.hot_pixels", "hot"),
              ("sensor.hot_rate_hz", "hot, Hz"), ("sensor.bandwidth_hz", "bandwidth, Hz"),
              ("street.road_contrast", "road"), ("street.facade_contrast", "facades"),
              ("street.house_share", "houses"), ("motion.vehicle.vibration_deg", "vibration, deg")]


def row_of(sequence: Sequence, method: str, results: Path) -> Row:
    """The row of a drive and method."""
    manifest, summary = Manifest(results / "manifest.json"), Summary(results / "summary.csv")
    metric = Manifest(results / "metric" / "manifest.json").value("scale") == "ground"
    metric_scale = Summary(results / "metric" / "judged" / "summary.csv").number("origin-scale", "scale")
    coverage = coverage_since_start(results / "trajectory.txt", results / "tracks.txt")
    failure = failure_of(results)
    track, odometry = manifest.stage_s("track"), manifest.stage_s("odometry")
    row: dict[str, Value] = {
        "seed": sequence.seed, "method": method, "recorded_s": manifest.value("recorded_s"),
        "events": manifest.count("events"), "coverage_since_start_share": coverage,
        "lost": int(bool(failure) or coverage is None or coverage < LOST_BELOW
                    or summary.number("origin-scale", "mean_planar_percent") is None),  # no scale fits a wrong one
        "rebootstraps": manifest.rebootstraps(), "ground_tracks": manifest.count("ground_tracks"),
        "has_metric_scale": int(metric), "metric_scale": metric_scale if metric else None,
        "metric_scale_error_percent": 100 * abs(metric_scale - 1) if metric and metric_scale is not None else None,
        "resting_share": ratio(resting_share(results / "tracks.txt"), 1.0, 100),
        "run_x_real_time": None if track is None else ratio(manifest.value("recorded_s"), track + (odometry or 0.0)),
        "failure": failure,
    }
    for column in ("path_m", "mean_planar_percent", "max_planar_percent", "kitti_translation_percent",
                   "kitti_rotation_deg_per_m", "nees_pose"):
        row[column] = summary.number("origin-scale", column)
    vertical = summary.number("origin-scale", "final_vertical_percent")
    row["final_vertical_percent"] = None if vertical is None else abs(vertical)
    return row


def percentile(values: List[Value], share: float) -> float | None:
    """The smallest of the known values that `share` of them do not exceed."""
    known = sorted(float(value) for value in values if value is not None)
    return known[max(0, -int(-share * len(known) // 1) - 1)] if known else None


def distribution(rows: List[Row]) -> list[Row]:
    """A row a quantity: median, 90th percentile and worst of each method."""
    methods = list(dict.fromkeys(str(row["method"]) for row in rows))
    lost: dict[str, Value] = {"quantity": "lost drives", "digits": "d"}
    table: list[Row] = [lost]
    for method in methods:
        lost[f"{method}_median"] = sum(int(row["lost"] or 0) for row in rows if row["method"] == method)
    for name, title, digits, _ in QUANTITIES:
        cells: dict[str, Value] = {"quantity": title, "digits": digits}
        for method in methods:
            values = [row[name] for row in rows if row["method"] == method]
            if name == "run_x_real_time":  # more is better
                values = [None if value is None else -float(value) for value in values]
            found = [median(values), percentile(values, 0.9), percentile(values, 1.0)]
            for kind, value in zip(("median", "90", "worst"), found):
                cells[f"{method}_{kind}"] = None if value is None else abs(value)
            cells[f"{method}_count"] = sum(1 for value in values if value is not None)
        table.append(cells)
    return table


class DigitsColumn(Column):
    """A column whose digits each row says."""

    def cell(self, row: Row) -> str:
        return Column(self.title, self.key, str(row["digits"])).cell(row)


def drawn_names(scene_file: str | None) -> str:
    """The names of what was drawn, as a drawn scene's second line has them."""
    match = re.search(r"^# drawn: (.*)$", scene_file or "", re.MULTILINE)
    return match[1] if match else ""


def badness(row: Row) -> tuple[int, float]:
    """Lost drives first, then by the mean planar error."""
    error = row["mean_planar_percent"]
    return (int(row["lost"] or 0), float(error) if error is not None else 1e9)


def worst_rows(rows: List[Row], simulator: Simulator, scene: Scene, count: int) -> list[Row]:
    """The worst drives of the first method with what was drawn."""
    method = rows[0]["method"]
    others = {row["seed"]: row for row in rows if row["method"] != method}
    chosen = sorted((row for row in rows if row["method"] == method), key=badness, reverse=True)[:count]
    found = []
    for row in chosen:
        parameters = simulator.parameters(scene, str(row["seed"]))
        other = others.get(row["seed"], {})
        folder = simulator.sequence(scene, str(row["seed"])).folder
        found.append({**row, **parameters, "other_mean_planar_percent": other.get("mean_planar_percent"),
                      "drawn": drawn_names(read_text(folder / DRAWN_SCENE)),
                      "events_per_s": ratio(row["events"], row["recorded_s"])})  # type: ignore[arg-type]
    return found


def sections(rows: List[Row], simulator: Simulator, scene: Scene, worst: int) -> list[Section]:
    """The distribution and the worst drives."""
    methods = list(dict.fromkeys(str(row["method"]) for row in rows))
    columns = [Column("", "quantity")]
    for method in methods:
        columns += [DigitsColumn(f"{method}: median", f"{method}_median"), DigitsColumn("90 %", f"{method}_90"),
                    DigitsColumn("worst", f"{method}_worst"), Column("drives", f"{method}_count", "d")]
    meanings = [Column(title, name, meaning=meaning) for name, title, _, meaning in QUANTITIES]
    drives = len({row["seed"] for row in rows})
    found = [Section(f"{drives} random drives of {scene.part.seconds} s", columns, distribution(rows))]  # type: ignore
    found[0].explained = meanings
    if worst == 0:
        return found
    table = [Column("seed", "seed"), Column("lost", "lost", "d"), Column("planar, %", "mean_planar_percent", ".3f"),
             Column("other method's", "other_mean_planar_percent", ".3f"),
             Column("restarts", "rebootstraps", "d"), Column("at rest, %", "resting_share", ".0f"),
             Column("nees", "nees_pose", ".1f"), Column("on ground", "ground_tracks", "d"),
             Column("Mev/s", "events_per_s", ".2f", 1e-6), Column("path, m", "path_m", ".0f"),
             *(Column(title, name) for name, title in PROPERTIES), Column("drawn", "drawn"), Column("failure", "failure")]
    return [*found, Section("The worst drives", table, worst_rows(rows, simulator, scene, worst))]


def target_rows(rows: List[Row]) -> list[Row]:
    """The targets beside what the first method reaches."""
    own = [row for row in rows if row["method"] == rows[0]["method"]]
    found: list[Row] = []
    for target in WORLD_TARGETS:
        values = [row[target.quantity] for row in own]
        value = {"median": lambda v: median(v), "90 %": lambda v: percentile(v, 0.9),
                 "worst": lambda v: percentile(v, 1.0), "sum": lambda v: float(sum(int(x or 0) for x in v))}[target.of](values)
        found.append({"scene": "random", "configuration": str(own[0]["method"]), "quantity": target.quantity,
                      "of": target.of, "target": f"{target.comparison} {target.limit:g}", "measured": value,
                      "result": verdict(value, target.comparison, target.limit), "stretch": None})
    return found
