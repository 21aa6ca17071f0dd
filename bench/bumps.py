"""The error of relative motion before and after the first bump of a scene."""
from __future__ import annotations

import re
from pathlib import Path

from bench import targets
from bench.errors import BenchError
from bench.files import Value, write_text
from bench.measures import Manifest, Summary, error_over_5_m_percent, ratio
from bench.program import Program
from bench.recordings import ground_truth_of
from bench.scenes import Sequence

WINDOW_S = 5.0  # before and after the bump
START_STAMP = "output.start_s"


def bump_stamp(sequence: Sequence, parameters: dict[str, str]) -> float | None:
    """The stamp of the scene's first bump, if the sequence has 5 s before and after it."""
    match = re.match(r'"?([0-9.]+)', parameters.get(targets.BUMPS_AT, ""))
    start = Manifest(sequence.folder / "manifest.json").parameter(START_STAMP)
    if not match or start is None:
        return None
    first = float(match[1])
    if first - WINDOW_S < sequence.part.start_s or first + WINDOW_S > sequence.part.end_s:
        return None
    return float(start) + first - sequence.part.start_s


def needs_judging(results: Path, stamp: float | None) -> bool:
    """Whether a finished run has a bump that is not judged yet."""
    return stamp is not None and (results / "complete").exists() and not (results / "bump").exists()


def judge_bump(program: Program, results: Path, folder: Path, stamp: float) -> None:
    """Judges the 5 s before and after a bump, in the scale of the whole run and with a scale of their own."""
    scale = Summary(results / "summary.csv").number("origin-scale", "scale")
    truth = ground_truth_of(folder)
    if scale is None or truth is None:
        return
    write_text(results / "bump" / "trajectory.txt",
               scaled((results / "trajectory.txt").read_text(encoding="utf-8"), scale))
    for part, begin in (("before", stamp - WINDOW_S), ("after", stamp)):
        try:
            program.output("evaluate", "--estimate", str(results / "bump" / "trajectory.txt"),
                           "--ground-truth", str(truth), "--align", "none,origin-scale", "--rpe", "5m",
                           "--rpe-pairs", "all", "--set", f"{targets.RPE_PAIRS_FROM}=truth",
                           "--from-stamp", f"{begin:.9f}", "--to-stamp", f"{begin + WINDOW_S:.9f}",
                           "--out", str(results / "bump" / part), "--no-plots", "--quiet")
        except BenchError as error:
            write_text(results / "bump" / f"{part}.txt", f"{error}\n")


def scaled(trajectory: str, scale: float) -> str:
    """A TUM trajectory with its positions times a scale."""
    lines = []
    for line in trajectory.splitlines():
        if line.startswith("#") or not line:
            continue
        cells = line.split()
        cells[1:4] = [f"{scale * float(cell):.9f}" for cell in cells[1:4]]
        lines.append(" ".join(cells))
    return "\n".join(lines) + "\n"


def bump_cells(results: Path) -> dict[str, Value]:
    """Errors before and after, and the growth, in both scales."""
    cells: dict[str, Value] = {}
    for prefix, alignment in (("", "none"), ("own_scale_", "origin-scale")):
        before = error_over_5_m_percent(results / "bump" / "before" / "metrics.csv", alignment)
        after = error_over_5_m_percent(results / "bump" / "after" / "metrics.csv", alignment)
        cells[f"{prefix}error_before_bump_percent"] = before
        cells[f"{prefix}error_after_bump_percent"] = after
        cells[f"{prefix}bump_growth"] = ratio(after, before)
    return cells
