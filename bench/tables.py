"""Medians over seeds and Markdown tables."""
from __future__ import annotations

import statistics
from dataclasses import dataclass
from typing import Callable, Iterable, Sequence

from bench.files import Row, Value


def median(values: Iterable[Value]) -> float | None:
    """The median of the values that are known."""
    known = [float(value) for value in values if value is not None]
    return statistics.median(known) if known else None


def worst(values: Iterable[Value], more_is_better: bool) -> float | None:
    """The least favourable of the values that are known."""
    known = [float(value) for value in values if value is not None]
    if not known:
        return None
    return min(known) if more_is_better else max(known)


@dataclass(frozen=True)
class Column:
    """A column of a table to read."""

    title: str
    key: str
    digits: str = ".2f"
    factor: float = 1.0
    meaning: str = ""  # one sentence; empty for columns that need none

    def cell(self, row: Row) -> str:
        """The column's text of a row."""
        return format_value(row.get(self.key), self.digits, self.factor)


@dataclass(frozen=True)
class SpreadColumn(Column):
    """A column of a summary: the median over the seeds and in parentheses the worst."""

    def cell(self, row: Row) -> str:
        text = format_value(row.get(f"{self.key}_median"), self.digits, self.factor)
        seeds = row.get("seeds")
        if text == "-" or not isinstance(seeds, int) or seeds < 2:
            return text
        return f"{text} ({format_value(row.get(f'{self.key}_worst'), self.digits, self.factor)})"


def format_value(value: Value, digits: str = ".2f", factor: float = 1.0) -> str:
    """A value as text: numbers with that many digits, nothing as a dash."""
    if value is None or value == "":
        return "-"
    if isinstance(value, str):
        return value
    scaled = value * factor
    return f"{round(scaled)}" if digits == "d" else f"{scaled:{digits}}"


def markdown(columns: Sequence[Column], rows: Sequence[Row]) -> str:
    """A Markdown table, padded so that it reads well as plain text, too."""
    cells = [[column.title for column in columns]]
    cells += [[column.cell(row).replace("|", "\\|") for column in columns] for row in rows]
    widths = [max(len(line[i]) for line in cells) for i in range(len(columns))]
    lines = ["| " + " | ".join(cell.ljust(width) for cell, width in zip(line, widths)) + " |" for line in cells]
    lines.insert(1, "|" + "|".join("-" * (width + 2) for width in widths) + "|")
    return "\n".join(lines) + "\n"


def group_rows(rows: Iterable[Row], key: Callable[[Row], tuple]) -> list[list[Row]]:
    """Rows with the same key, in the order in which the keys first appear."""
    groups: dict[tuple, list[Row]] = {}
    for row in rows:
        groups.setdefault(key(row), []).append(row)
    return list(groups.values())
