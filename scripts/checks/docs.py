"""Documents: links resolve; the files, commands, options and parameters in them exist; generated files are current."""

from __future__ import annotations

import re
import subprocess
from functools import cached_property
from pathlib import Path

README_LINES = 150
# Documents that tell of earlier versions name what existed then.
_HISTORY = {"CHANGELOG.md"}
# This one is the program's own words, former names included.
_GENERATED = {"docs/parameters.md"}

_LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
_HEADING = re.compile(r"^#+ (.+)$", re.M)
_PATH = re.compile(r"`((?:src|include|configs|scripts|tests|docs|bench|cmake|data_samples)/[\w./-]*\w)`")
_GROUPS = "tracker|odometry|evaluation|street|motion|sensor|simulation|output|scene|road"
_PARAMETER = re.compile(rf"\b((?:{_GROUPS})(?:\.[a-z_0-9]+)+)\b")
_FILE_ENDINGS = ("hpp", "cpp", "py", "md", "yaml", "txt", "csv", "json")
# In code: after a backtick, or in an indented line, also with a path before it.
_COMMAND = re.compile(r"(?:`|^ {4}|\n {4}|/)(?:[\w./-]*/)?evo-run ([a-z]+)\b([^`|;#]*)")
_OPTION = re.compile(r"(?<![\w-])--([a-z][a-z-]*)")


class Program:
    """What a built evo-run says of itself."""

    def __init__(self, binary: Path) -> None:
        self._binary = binary

    def output(self, *arguments: str) -> str:
        done = subprocess.run([str(self._binary), *arguments], capture_output=True, text=True, check=False)
        return done.stdout if done.returncode == 0 else ""

    @cached_property
    def commands(self) -> dict[str, set[str]]:
        """Options by command."""
        listed = self.output("--help").split("Subcommands:")[-1]
        names = re.findall(r"^  ([a-z]+)\s", listed, re.M)
        return {name: set(_OPTION.findall(self.output(name, "--help"))) for name in names}

    @cached_property
    def parameters(self) -> set[str]:
        """Names in the default configuration and in the scenes."""
        names = _yaml_names(self.output("config", "--print"))
        for scene in ("driving_day", "slider", "handheld_boxes"):
            names |= _yaml_names(self.output("simulate", f"configs/scenes/{scene}.yaml", "--print"))
        return names


def _yaml_names(yaml: str) -> set[str]:
    names = set()
    path: list[str] = []
    for line in yaml.splitlines():
        match = re.match(r"( *)([a-z_0-9]+):(.*)", line)
        if not match:
            continue
        depth = len(match.group(1)) // 2
        path = path[:depth] + [match.group(2)]
        names.add(".".join(path))
    return names


def documents(root: Path) -> list[Path]:
    return sorted([*root.glob("*.md"), *(root / "docs").rglob("*.md"), *(root / "data_samples").glob("*.md")])


def check(root: Path, binary: Path | None) -> list[str]:
    """Every violation as one line `file:line: what is wrong`; without a binary, what needs none."""
    problems = []
    program = Program(binary) if binary else None
    for path in documents(root):
        name = path.relative_to(root).as_posix()
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
            found = _broken_links(root, path, line)
            if name not in _HISTORY | _GENERATED:
                found += [f"there is no {p}" for p in _PATH.findall(line) if not _exists(root, p)]
                found += _unknown_names(program, line) if program else []
            problems += [f"{name}:{number}: {problem}" for problem in found]
    lines = len((root / "README.md").read_text(encoding="utf-8").splitlines())
    if lines > README_LINES:
        problems.append(f"README.md:{lines}: has {lines} lines, {README_LINES} at most; move details to docs")
    return problems + (_outdated(root, program) if program else [])


def _exists(root: Path, path: str) -> bool:
    return (root / path).exists() or any(root.glob(path + ".*"))


def _anchor(heading: str) -> str:
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


def _broken_links(root: Path, path: Path, line: str) -> list[str]:
    problems = []
    for target in _LINK.findall(line):
        if re.match(r"[a-z]+:", target):
            continue
        file, _, anchor = target.partition("#")
        linked = (path.parent / file).resolve() if file else path
        if not linked.exists() or not linked.is_relative_to(root.resolve()):
            problems.append(f"link to {target}, which does not exist")
        elif anchor and anchor not in map(_anchor, _HEADING.findall(linked.read_text(encoding="utf-8"))):
            problems.append(f"link to {target}, but {linked.name} has no such heading")
    return problems


def _unknown_names(program: Program, line: str) -> list[str]:
    problems = []
    for command, rest in _COMMAND.findall(line):
        if command not in program.commands:
            problems.append(f"evo-run has no command '{command}'")
            continue
        known = program.commands[command] | {"help"}
        problems += [f"evo-run {command} has no option --{o}" for o in _OPTION.findall(rest) if o not in known]
    for name in _PARAMETER.findall(line):
        if name.rsplit(".", 1)[-1] not in _FILE_ENDINGS and name not in program.parameters:
            problems.append(f"there is no parameter '{name}'")
    return problems


def _outdated(root: Path, program: Program) -> list[str]:
    problems = []
    for file, option in (("configs/default.yaml", "--print"), ("docs/parameters.md", "--markdown")):
        path = root / file
        if not path.exists() or path.read_text(encoding="utf-8") != program.output("config", option):
            problems.append(f"{file}:1: is out of date; run evo-run config {option} > {file}")
    return problems
