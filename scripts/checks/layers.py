"""Layering: what a module may include, where a header lies, and in which namespace a module's names are."""

from __future__ import annotations

import re
from pathlib import Path

from .source import MODULES, Source, sources

_NAMESPACE = re.compile(r"^namespace (evo[\w:]*) \{", re.M)
# A module may declare a class of core without its header.
_FORWARD_DECLARATION = re.compile(r"^namespace evo \{\s*(?:(?:class|struct) \w+;\s*)+\}.*$", re.M)


def check(root: Path) -> list[str]:
    """Every violation as one line `file:line: what is wrong`."""
    files = sources(root)
    problems = []
    for source in files:
        if source.module not in MODULES:
            if not source.is_test:
                problems.append(f"{source.name}:1: '{source.module}' is no module; see scripts/checks/source.py")
            continue
        problems += _wrong_includes(source) + _wrong_namespaces(source)
    return problems + _unshared_headers(files)


def _wrong_includes(source: Source) -> list[str]:
    problems = []
    for include in source.includes():
        place = f"{source.name}:{include.line}:"
        if include.module not in MODULES or include.path.startswith("tests/"):
            problems.append(f'{place} "{include.path}" does not start with a module; give the path from src or tests')
            continue
        if source.is_test:
            continue
        if MODULES.index(include.module) > MODULES.index(source.module):
            problems.append(f"{place} {source.module} must not include {include.module}, which is a layer above it")
        elif include.module != source.module and not include.is_public:
            problems.append(f'{place} "{include.path}" is private to {include.module}; include its public headers only')
        elif source.name.startswith("include/") and not include.is_public:
            problems.append(f'{place} a public header must not include the private "{include.path}"')
    return problems


def _wrong_namespaces(source: Source) -> list[str]:
    wanted = "evo" if source.module == "core" else f"evo::{source.module}"
    found = _NAMESPACE.findall(_FORWARD_DECLARATION.sub("", source.text()))
    wrong = [name for name in found if name != wanted and not name.startswith(wanted + "::")]
    if source.module == "core":
        wrong = [name for name in found if name.split("::")[1:2] and name.split("::")[1] in MODULES]
    return [f"{source.name}:1: namespace {name} should be {wanted}" for name in wrong]


def _unshared_headers(files: list[Source]) -> list[str]:
    """Public headers that no other module includes, neither itself nor through another public header."""
    used: set[str] = set()
    todo = []
    for source in files:
        for include in source.includes():
            if include.is_public and include.module != source.module and not source.is_test:
                todo.append(include.path)
    by_path = {source.name.removeprefix("include/"): source for source in files if source.name.startswith("include/")}
    while todo:
        path = todo.pop()
        if path in used or path not in by_path:
            continue
        used.add(path)
        todo += [include.path for include in by_path[path].includes()]
    return [
        f"include/{path}:1: no other module includes this header; move it beside its source in src"
        for path in sorted(by_path)
        if path not in used
    ]
