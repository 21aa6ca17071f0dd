#!/usr/bin/env python3
"""Checks layering, names of transforms, includes and documents. One line a violation; exit code 1 if any."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from checks import docs, includes, layers, transforms  # noqa: E402


def main() -> int:
    example = "example: scripts/check.py --evo-run build/release/bin/evo-run"
    parser = argparse.ArgumentParser(description=__doc__, epilog=example)
    root = Path(__file__).resolve().parent.parent
    parser.add_argument("--evo-run", type=Path, metavar="FILE",
                        help="a built evo-run: also checks the names in the documents")
    arguments = parser.parse_args()
    problems = layers.check(root) + transforms.check(root) + includes.check(root) + docs.check(root, arguments.evo_run)
    for problem in problems:
        print(problem, file=sys.stderr)
    clean = "layering, transforms, includes and documents are clean"
    print(f"check: {len(problems)} problems" if problems else f"check: {clean}")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
