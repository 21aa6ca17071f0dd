"""Names of transforms: T_a_b takes coordinates in frame b to frame a, so neighbours in a product share a frame."""

from __future__ import annotations

import re
from pathlib import Path

from .source import sources

_DECLARED = re.compile(r"\bSE3\s*[&*]?\s+(\w+)\s*(?=[;,)={(\[]|$)", re.M)
_FUNCTION = re.compile(r"[A-Z]\w*$")
_TRANSFORM = re.compile(r"T_([a-z0-9]+)_([a-z0-9]+)(_\w+)?_?$")
_FACTOR = r"\bT_([a-z0-9]+)_([a-z0-9]+)(?:_\w+?)?_?(\.Inverse\(\))?"
_PRODUCT = re.compile(_FACTOR + r" \* " + _FACTOR + r"(?![\w.])")
_GENERIC = {"a", "b", "other"}  # the two arguments of a rule that holds for any frames


def check(root: Path) -> list[str]:
    """Every violation as one line `file:line: what is wrong`."""
    problems = []
    for source in sources(root):
        for number, line in enumerate(source.code().splitlines(), start=1):
            place = f"{source.name}:{number}:"
            if not source.is_test:
                problems += [f"{place} {problem}" for problem in _wrong_names(line)]
            problems += [f"{place} {problem}" for problem in _broken_products(line)]
    return problems


def _wrong_names(line: str) -> list[str]:
    return [
        f"the transform '{name}' should be called T_to_from"
        for name in _DECLARED.findall(line)
        if not _FUNCTION.match(name) and name not in _GENERIC and not _TRANSFORM.match(name)
    ]


def _broken_products(line: str) -> list[str]:
    problems = []
    position = 0
    while match := _PRODUCT.search(line, position):
        to_left, from_left, left_inverse, to_right, from_right, right_inverse = match.groups()
        inner_left = to_left if left_inverse else from_left
        inner_right = from_right if right_inverse else to_right
        if inner_left != inner_right:
            problems.append(f"'{match.group()}' joins frame '{inner_left}' with frame '{inner_right}'")
        position = match.start() + 1
    return problems
