"""The tables of a benchmark: printed, kept as Markdown, and recorded with the build for docs/benchmarks.md."""
from __future__ import annotations

import json
from dataclasses import dataclass, field
from datetime import datetime, timezone
from pathlib import Path
from typing import Any, Sequence

from bench.files import Row, write_text
from bench.options import Bench
from bench.program import describe_machine
from bench.runner import KEY_FILE
from bench.scenes import simulated_by
from bench.tables import Column, markdown

TARGET_COLUMNS = [
    Column("scene", "scene"),
    Column("configuration", "configuration"),
    Column("quantity", "quantity"),
    Column("over the seeds", "of"),
    Column("target", "target"),
    Column("stretch", "stretch"),
    Column("measured", "measured", ".3g"),
    Column("result", "result"),
]


@dataclass
class Section:
    """A table with its title and a remark."""

    title: str
    columns: Sequence[Column]
    rows: Sequence[Row]
    note: str = ""
    explained: Sequence[Column] = ()  # further quantities with their meanings

    def text(self) -> str:
        """The table in Markdown."""
        note = f"{self.note}\n\n" if self.note else ""
        return f"{self.title}\n\n{note}{markdown(self.columns, self.rows)}"

    def explanations(self) -> list[list[str]]:
        """Title and meaning of the columns that need one."""
        return [[column.title, column.meaning] for column in [*self.columns, *self.explained] if column.meaning]


@dataclass
class Outcome:
    """All that a benchmark has measured."""

    name: str  # of its files
    sections: list[Section]
    targets: list[Row] = field(default_factory=list)
    results: list[Path] = field(default_factory=list)  # folders of the runs
    sequences: list[Path] = field(default_factory=list)  # folders of the simulated sequences
    figures: list[str] = field(default_factory=list)  # SVG files in the output folder
    in_docs: list[Section] | None = None  # instead of `sections` in docs/benchmarks.md
    failed: bool = False


def report(bench: Bench, outcome: Outcome) -> int:
    """Prints the tables, writes OUT/NAME.md and OUT/NAME.json and returns the exit code."""
    parts = [section.text() for section in outcome.sections]
    if outcome.targets:
        parts.append("Targets\n\n" + markdown(TARGET_COLUMNS, outcome.targets))
    parts.append(f"{bench.threads} threads on {describe_machine()}\n")
    text = "\n".join(parts)
    write_text(bench.out / f"{outcome.name}.md", text)
    write_text(bench.out / f"{outcome.name}.json", json.dumps(record_of(bench, outcome), indent=1) + "\n")
    print(text, end="", flush=True)
    return 1 if outcome.failed else 0


def record_of(bench: Bench, outcome: Outcome) -> dict[str, Any]:
    """What docs/benchmarks.md needs to know of a benchmark."""
    sections = outcome.sections if outcome.in_docs is None else outcome.in_docs
    simulators = {simulated_by(folder).get("program", "") for folder in outcome.sequences}
    return {
        "program": bench.program.checksum,
        "version": bench.program.version,
        "commit": bench.program.source_state,
        "machine": describe_machine(),
        "threads": bench.threads,
        "seeds": bench.seeds,
        "command": bench.command,
        "measured": measured_between(outcome.results),
        "other_simulators": sorted(name[:12] or "unknown" for name in simulators - {bench.program.checksum}),
        "sections": [{"title": section.title, "note": section.note, "table": markdown(section.columns, section.rows),
                      "columns": section.explanations()} for section in sections],
        "targets": [dict(row) for row in outcome.targets],
        "figures": outcome.figures,
        "failed": outcome.failed,
    }


def measured_between(results: Sequence[Path]) -> list[str]:
    """The days of the first and the last run."""
    stamps = [file.stat().st_mtime for file in (folder / KEY_FILE for folder in results) if file.exists()]
    return [datetime.fromtimestamp(stamp, timezone.utc).strftime("%Y-%m-%d")
            for stamp in ([min(stamps), max(stamps)] if stamps else [])]
