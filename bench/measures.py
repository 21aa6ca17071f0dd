"""Reading what evo-run writes: manifest.json, summary.csv, metrics.csv, track_quality.csv, lifetime.csv."""
from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from bench.files import read_csv, read_text

GAP_S = 0.5  # a longer stretch without a pose is not covered, as evaluation.gap_s has it


def number(text: str | None) -> float | None:
    """A cell as a number; nothing where the cell is empty or missing."""
    return None if text is None or text == "" else float(text)


def ratio(a: float | None, b: float | None, factor: float = 1.0) -> float | None:
    """factor * a / b; nothing where one is missing or b is not positive."""
    return None if a is None or b is None or b <= 0 else factor * a / b


class Manifest:
    """manifest.json of a run; every value is missing where there is none."""

    def __init__(self, path: Path) -> None:
        text = read_text(path)
        self.exists = text is not None
        self._json: dict[str, Any] = json.loads(text) if text else {}

    def count(self, name: str) -> int | None:
        """A number of things."""
        return self._json.get("counts", {}).get(name)

    def stage_s(self, name: str) -> float | None:
        """The wall time of a stage."""
        return self._json.get("wall_time_s", {}).get(name)

    def value(self, name: str) -> float | None:
        """recorded_s, cpu_time_s or peak_memory_mb."""
        return self._json.get(name)

    def rebootstraps(self) -> int | None:
        """How often the map was started again."""
        stamps = self._json.get("rebootstraps")
        return None if stamps is None else len(stamps)

    def parameter(self, name: str) -> Any:
        """A parameter by its full name."""
        node: Any = self._json.get("parameters", {})
        for part in name.split("."):
            node = node.get(part) if isinstance(node, dict) else None
        return node


class Quantities:
    """track_quality.csv or lifetime.csv: values by quantity, unit and threshold."""

    def __init__(self, path: Path) -> None:
        self._rows = [list(row.values()) for row in read_csv(path)]

    def text(self, name: str, unit: str, threshold: float | None = None) -> str | None:
        """The first such value as it stands there."""
        for row in self._rows:
            if row[0] == name and row[1] == unit and number(row[2]) == threshold:
                return row[-1]
        return None

    def number(self, name: str, unit: str, threshold: float | None = None) -> float | None:
        """The first such value."""
        return number(self.text(name, unit, threshold))


class Summary:
    """summary.csv: a row for each alignment."""

    def __init__(self, path: Path) -> None:
        self._rows = {row["alignment"]: row for row in reversed(read_csv(path))}

    def number(self, alignment: str, column: str) -> float | None:
        """A cell; nothing where there is no such alignment."""
        return number(self._rows.get(alignment, {}).get(column))


def rotation_drift_deg_per_m(metrics: Path) -> float | None:
    """The mean drift of the rotation over the longest sub-trajectories."""
    found = [row for row in read_csv(metrics)
             if (row["alignment"], row["metric"], row["quantity"], row["unit"]) ==
             ("origin-scale", "subtrajectory", "rotation", "deg/m")]
    return number(found[-1]["mean"]) if found else None


def error_over_5_m_percent(metrics: Path, alignment: str) -> float | None:
    """The mean relative error of the translation between poses 5 m apart."""
    for row in read_csv(metrics):
        if (row["alignment"], row["metric"], row["quantity"]) == (alignment, "rpe", "translation"):
            mean = number(row["mean"])
            return None if mean is None else 20 * mean
    return None


def _stamps(path: Path, column: int) -> list[float]:
    """A column of a text file with # comments."""
    text = read_text(path) or ""
    return [float(line.split()[column]) for line in text.splitlines() if line and not line.startswith("#")]


def track_duration_s(tracks: Path) -> float | None:
    """The time between the first and the last position in a track file `id stamp x y`."""
    stamps = _stamps(tracks, 1)
    return max(stamps) - min(stamps) if stamps else None


def last_track_stamp(tracks: Path) -> str | None:
    """The stamp of the last position of a sorted track file, as it stands there."""
    text = read_text(tracks)
    return text.splitlines()[-1].split()[1] if text else None


def resting_share(tracks: Path) -> float | None:
    """The share of the observations that belong to tracks of 15 frames and more which move by less than 6 px/s."""
    first: dict[str, list[float]] = {}
    last: dict[str, list[float]] = {}
    counts: dict[str, int] = {}
    for line in (read_text(tracks) or "").splitlines():
        if not line or line.startswith("#"):
            continue
        name, *values = line.split()[:4]
        position = [float(value) for value in values]
        first.setdefault(name, position)
        last[name] = position
        counts[name] = counts.get(name, 0) + 1
    resting = 0
    for name, count in counts.items():
        (t0, x0, y0), (t1, x1, y1) = first[name], last[name]
        if count >= 15 and (x1 - x0) ** 2 + (y1 - y0) ** 2 < (6 * (t1 - t0)) ** 2:
            resting += count
    return ratio(resting, sum(counts.values()))


def coverage_since_start(trajectory: Path, tracks: Path) -> float | None:
    """The share of the time from the first pose to the last tracks outside stretches without a pose."""
    poses = _stamps(trajectory, 0)
    if not poses:
        return None
    end = max(_stamps(tracks, 1), default=poses[-1])
    gaps = [b - a for a, b in zip(poses, poses[1:])] + [end - poses[-1]]
    missing = sum(gap for gap in gaps if gap > GAP_S)
    return 1 - missing / (end - poses[0]) if end > poses[0] else None


def failure_of(results: Path) -> str:
    """Why a run has no results, or none that could be judged; empty where all is well."""
    text = read_text(results / "failure.txt")
    if text is not None:
        return text.strip()
    judging = read_text(results / "judging.txt")
    if judging is None:
        return ""
    lines = judging.strip().splitlines()
    return f"not judged: {lines[-1] if lines else 'no message'}"
