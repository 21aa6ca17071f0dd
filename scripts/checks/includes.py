"""Includes: a source names its own header first, and includes no project header of which it uses nothing."""

from __future__ import annotations

import re
from pathlib import Path

from .source import Source, sources

_DECLARATIONS = re.compile(
    r"^(?:template <[^\n]*>\n)?"
    r"(?:(?:enum class|enum|class|struct)\s+(?P<type>\w+)"
    r"|using\s+(?P<alias>\w+)\s*="
    r"|(?:extern |inline |constexpr |const )*[\w:<>,&*\s\[\]]*?[\s&*](?P<name>\w+)\s*(?:\(|=|;|\{|\[))",
    re.M,
)
_NAMED = re.compile(r"\b[A-Za-z_]\w*\b")


def check(root: Path) -> list[str]:
    """Every violation as one line `file:line: what is wrong`."""
    files = sources(root)
    by_path = {}
    for source in files:
        for top in ("include/", "src/", "tests/"):
            if source.name.startswith(top):
                by_path[source.name.removeprefix(top)] = source
    problems = []
    for source in files:
        problems += _own_header_later(source, by_path) + _unused(source, by_path)
    return problems


def _own_header_later(source: Source, by_path: dict[str, Source]) -> list[str]:
    if source.path.suffix != ".cpp" or source.is_test:
        return []
    same = source.name.removeprefix("src/").removesuffix(".cpp") + ".hpp"
    public = f"evo/{source.module}/{source.path.stem}.hpp"
    own = [i for i in source.includes() if i.path in (same, public)]
    first = next((line for line in source.text().splitlines() if line.startswith("#include")), "")
    return [f'{source.name}:{i.line}: its own header "{i.path}" should come first' for i in own if i.path not in first]


def declared(text: str) -> set[str]:
    """Names that a header declares at any depth: more than it exports, so that the check never cries wolf."""
    names = set()
    for match in _DECLARATIONS.finditer(text):
        names.add(match.group("type") or match.group("alias") or match.group("name"))
    return names


def _unused(source: Source, by_path: dict[str, Source]) -> list[str]:
    used = set(_NAMED.findall(re.sub(r"^#include.*$", "", source.code(), flags=re.M)))
    problems = []
    for include in source.includes():
        header = by_path.get(include.path)
        tested = source.path.stem.removesuffix("_test")
        if header is None or Path(include.path).stem in (source.path.stem, tested):
            continue
        if not declared(header.code()) & used:
            problems.append(f'{source.name}:{include.line}: nothing of "{include.path}" is used')
    return problems
