"""Source files of the tree: which module each belongs to and what it includes."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

# A module includes only itself and those above it in this list.
MODULES = ["core", "geometry", "events", "io", "tracking", "odometry", "evaluation", "simulation", "report", "app"]

_INCLUDE = re.compile(r'^#include "([^"]+)"')
_STRIPPED = re.compile(r'"(?:\\.|[^"\\\n])*"|//[^\n]*|/\*.*?\*/', re.S)


@dataclass(frozen=True)
class Include:
    """One `#include "..."` line."""

    line: int
    path: str

    @property
    def is_public(self) -> bool:
        return self.path.startswith("evo/")

    @property
    def module(self) -> str:
        parts = self.path.split("/")
        return parts[1] if self.is_public else parts[0]


@dataclass(frozen=True)
class Source:
    """A C++ file below src, include/evo, tests or bench."""

    root: Path
    path: Path

    @property
    def name(self) -> str:
        return self.path.relative_to(self.root).as_posix()

    @property
    def is_test(self) -> bool:
        return self.name.startswith(("tests/", "bench/"))

    @property
    def module(self) -> str:
        parts = self.name.split("/")
        return parts[2] if parts[0] == "include" else parts[1]

    def text(self) -> str:
        return self.path.read_text(encoding="utf-8")

    def code(self) -> str:
        """The text with comments and strings blanked out, line by line as it was."""
        return _STRIPPED.sub(lambda m: re.sub(r"[^\n]", " ", m.group()), self.text())

    def includes(self) -> list[Include]:
        found = []
        for number, line in enumerate(self.text().splitlines(), start=1):
            match = _INCLUDE.match(line)
            if match:
                found.append(Include(number, match.group(1)))
        return found


def sources(root: Path) -> list[Source]:
    """All C++ files, in order of their names."""
    found = []
    for top in ("include", "src", "tests", "bench"):
        for pattern in ("*.hpp", "*.cpp"):
            found += [Source(root, path) for path in (root / top).rglob(pattern)]
    return sorted(found, key=lambda source: source.name)
