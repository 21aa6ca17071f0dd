"""The configurations of the pipeline that are compared: ours, files, and variants of ours."""
from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from bench.errors import BenchError
from bench.program import CONFIGS, Program

OURS = "ours"
_VARIANT = re.compile(r"[^=\s,]+=[^\s,]*(\s+[^=\s,]+=[^\s,]*)*")


@dataclass(frozen=True)
class Configuration:
    """What evo-run is called with, by its name in the tables."""

    label: str
    options: tuple[str, ...]
    file: Path | None = None

    @property
    def folder(self) -> str:
        """The label as a folder's name."""
        return re.sub(r"[ /]", "_", self.label)

    def contents(self) -> str:
        """The text of its file."""
        return "" if self.file is None else self.file.read_text(encoding="utf-8")


def from_name(name: str) -> Configuration:
    """`ours`, a file in configs, or a file."""
    if name == OURS:
        return Configuration(OURS, ())
    file = Path(name) if Path(name).is_file() else CONFIGS / f"{name}.yaml"
    if not file.is_file():
        raise BenchError(f"--config: there is no configuration {name}, here or in {CONFIGS}")
    return Configuration(file.stem, ("--config", str(file)), file)


def from_settings(text: str) -> Configuration:
    """Ours but for NAME=VALUE, several with blanks between them."""
    if not _VARIANT.fullmatch(text):
        raise BenchError(f"--set cannot be '{text}': NAME=VALUE, or several with blanks between them, without commas")
    return Configuration(text, tuple(word for setting in text.split() for word in ("--set", setting)))


def configurations(names: list[str], variants: list[str], program: Program) -> list[Configuration]:
    """All of them, checked: names differ and every parameter exists."""
    found = [from_name(name) for name in names] + [from_settings(text) for text in variants]
    labels = [item.label for item in found]
    for label in labels:
        if labels.count(label) > 1:
            raise BenchError(f"--config, --set: there are two configurations with the name {label}")
    for item in found:
        try:
            program.output("config", "--print", *item.options)
        except BenchError as error:
            raise BenchError(f"{item.label}: {error}") from None
    return found
