"""Files that appear whole or not at all."""
from __future__ import annotations

import csv
import io
import os
from pathlib import Path
from typing import Iterable, Mapping, Sequence

Value = float | int | str | None
Row = Mapping[str, Value]


def write_text(path: Path, text: str) -> None:
    """Writes a file at once; an interrupted write leaves the earlier file."""
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(path.name + ".part")
    part.write_text(text, encoding="utf-8")
    os.replace(part, path)


def read_text(path: Path) -> str | None:
    """The text of a file, or nothing where there is none."""
    try:
        return path.read_text(encoding="utf-8")
    except FileNotFoundError:
        return None


def csv_cell(value: Value) -> str:
    """A value as a CSV cell: nothing where it is not known."""
    if value is None:
        return ""
    return f"{value:.9g}" if isinstance(value, float) else str(value)


def write_csv(path: Path, columns: Sequence[str], rows: Iterable[Row]) -> None:
    """Writes rows with a header."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    for row in rows:
        writer.writerow([csv_cell(row.get(column)) for column in columns])
    write_text(path, text.getvalue())


def read_csv(path: Path) -> list[dict[str, str]]:
    """The rows of a CSV file by the names of its columns; none where there is no file."""
    text = read_text(path)
    return [] if text is None else list(csv.DictReader(io.StringIO(text)))
