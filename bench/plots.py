"""SVG plots by gnuplot; without it the script and its data are left for later."""
from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path
from typing import Sequence

from bench.files import Row, write_text

Line = tuple[str, list[tuple[float, float]]]  # title and points


def draw(out: Path, name: str) -> list[str]:
    """Draws OUT/NAME.gnuplot and returns the names of the figures. A plot that fails is said and left out."""
    if shutil.which("gnuplot") is None:
        print(f"gnuplot is not installed: {out / name}.gnuplot is left for later", file=sys.stderr)
        return []
    if subprocess.run(["gnuplot", f"{name}.gnuplot"], cwd=out, check=False).returncode != 0:
        print(f"{out / name}.gnuplot could not be drawn", file=sys.stderr)
        return []
    return [f"{name}.svg"]


def plot_lines(out: Path, name: str, x_label: str, panels: Sequence[tuple[str, list[Line]]]) -> list[str]:
    """Panels side by side, each with a label of its y axis and lines with points."""
    script = [
        f'set terminal svg size {500 * len(panels)},400 noenhanced background "white"',
        f'set output "{name}.svg"',
        f"set multiplot layout 1,{len(panels)}",
        f'set xlabel "{x_label}"',
        "set xrange [0:*]",
        "set yrange [0:*]",
        "set grid",
        "set key bottom right",
    ]
    data: list[str] = []
    index = 0
    for label, lines in panels:
        plots = []
        for title, points in lines:
            data += [f"{x:.9g} {y:.9g}" for x, y in points] + ["", ""]
            plots.append(f'"{name}.dat" index {index} using 1:2 with linespoints title "{title}"')
            index += 1
        if plots:
            script += [f'set ylabel "{label}"', "plot " + ", \\\n  ".join(plots)]
    if index == 0:
        return []
    write_text(out / f"{name}.dat", "\n".join(data) + "\n")
    write_text(out / f"{name}.gnuplot", "\n".join(script) + "\n")
    return draw(out, name)


def plot_bars(out: Path, name: str, y_label: str, rows: Sequence[Row], group: str, bar: str, value: str) -> list[str]:
    """A bar for each row, in clusters of the same `group`, on a logarithmic axis."""
    groups = list(dict.fromkeys(str(row[group]) for row in rows))
    bars = list(dict.fromkeys(str(row[bar]) for row in rows))
    cells = {(row[group], row[bar]): row.get(value) for row in rows}
    if not any(isinstance(cell, (int, float)) and cell > 0 for cell in cells.values()):
        return []
    lines = [",".join(["scene", *bars])]
    for g in groups:
        found = [cells.get((g, b)) for b in bars]
        lines.append(",".join([g, *("?" if cell is None or cell <= 0 else f"{cell:.9g}" for cell in found)]))
    write_text(out / f"{name}.dat", "\n".join(lines) + "\n")
    script = f"""set terminal svg size {360 + len(groups) * (40 + 20 * len(bars))},450 noenhanced background "white"
set output "{name}.svg"
set datafile separator ","
set datafile missing "?"
set style data histogram
set style histogram clustered gap 1
set style fill solid 0.8
set logscale y
set yrange [0.01:*]
set grid ytics
set xtics rotate by -30
set rmargin 15
set key outside top horizontal
set ylabel "{y_label}"
plot for [i=2:{len(bars) + 1}] "{name}.dat" using i:xtic(1) title columnheader(i)
"""
    write_text(out / f"{name}.gnuplot", script)
    return draw(out, name)


def plot_drift(out: Path, name: str, title: str, files: Sequence[tuple[str, Path]]) -> list[str]:
    """The planar error over the distance, a line for each errors.csv with its title."""
    if not files:
        return []
    lines = [f'"{file.relative_to(out)}" using 2:6 with lines title "{label}"' for label, file in files]
    script = f"""set terminal svg size 800,450 noenhanced background "white"
set output "{name}.svg"
set datafile separator ","
set title "{title}"
set logscale y
set grid
set key outside top horizontal
set xlabel "distance, m"
set ylabel "planar error, origin-scale, m"
plot """
    write_text(out / f"{name}.gnuplot", script + ", \\\n  ".join(lines) + "\n")
    return draw(out, name)
