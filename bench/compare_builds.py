"""Comparing the outputs of two builds byte by byte."""
from __future__ import annotations

import filecmp
import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from bench.compare_commands import Command, commands
from bench.errors import BenchError
from bench.options import parser
from bench.program import ROOT, Program, find_program, source_tree
from bench.runner import Job, do
from bench.tables import Column, markdown

DESCRIPTION = """\
Runs a fixed list of commands with two binaries and compares every file that they write, what they print and their exit
codes, byte by byte: track, run, odometry, evaluate, report and simulate in both formats, on 1 and 2 threads, with KLT,
with configs/paper.yaml, on the bundled samples, short simulated scenes and, with --street, one more recording. Prints a table
`output | result` and ends with 1 if anything differs that may not. Each binary uses the configs folder of its own
source tree. Both binaries are called with the same names of parameters, the old ones."""
EXAMPLES = """\
examples:
  python3 -m bench compare /tmp/old/build/release/bin/evo-run build/release/bin/evo-run
  python3 -m bench compare OLD NEW --street /data/street_12s --keep out/compare --all"""

# Outputs that may differ: pattern of the path below the output folder, and why.
MAY_DIFFER = [
    (r"(^|/)manifest\.json$", "version, command line, times, memory, names of parameters"),
    (r"(^|/)plots/", "looks of the plots"),
    (r"\.html$", "looks of the pages"),
    (r"(^|/)runs\.(csv|tex)$", "a table of many runs holds wall times and differing parameters"),
    (r"^config_", "names and descriptions of parameters"),
    (r"^simulate_print", "names and descriptions of parameters"),
    (r"(^|/)images/", "looks of the drawn event frames"),
    (r"(^|/)stderr\.txt$", "wording and times of the log"),
]
# Parts of what is printed that hold times, and the folder that a binary works in.
TIMES = re.compile(r"^speed .*$|^results .*$|^file .*$", re.MULTILINE)
COLUMNS = [Column("output", "output"), Column("result", "result"), Column("remark", "remark")]


@dataclass(frozen=True)
class Difference:
    """The comparison of an output: same, differs, only in OLD or only in NEW, and why that is allowed."""

    output: str
    result: str
    allowed: str

    @property
    def counts(self) -> bool:
        """Whether it makes the builds differ."""
        return self.result != "same" and not self.allowed


def allowance(output: str) -> str:
    """Why an output may differ; empty if it may not."""
    return next((reason for pattern, reason in MAY_DIFFER if re.search(pattern, output)), "")


def run_one(program: Program, configs: Path, command: Command, place: Path) -> None:
    """Runs a command in PLACE; its exit code and what it prints are outputs, too."""
    out = place / command.name
    out.mkdir(parents=True, exist_ok=True)
    words = [word.format(configs=configs, data=ROOT / "data_samples", place=".", out=command.name)
             for word in command.words]
    result = subprocess.run([str(program.path), *words], cwd=place, capture_output=True, text=True, check=False)
    (out / "stdout.txt").write_text(TIMES.sub("", result.stdout), encoding="utf-8")
    (out / "stderr.txt").write_text(result.stderr, encoding="utf-8")
    (out / "exit_code.txt").write_text(f"{result.returncode}\n", encoding="utf-8")


def files_below(folder: Path) -> set[str]:
    """The paths of all files in a folder."""
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}


def compare_folders(old: Path, new: Path) -> list[Difference]:
    """All outputs in the order of their names."""
    in_old, in_new = files_below(old), files_below(new)
    found = []
    for output in sorted(in_old | in_new):
        if output not in in_new:
            result = "only in OLD"
        elif output not in in_old:
            result = "only in NEW"
        else:
            result = "same" if filecmp.cmp(old / output, new / output, shallow=False) else "differs"
        found.append(Difference(output, result, allowance(output)))
    return found


def failures(place: Path, todo: list[Command]) -> list[str]:
    """The commands that failed, with their messages; nothing is compared where both fail."""
    return [f"{command.name}: exit code {(place / command.name / 'exit_code.txt').read_text().strip()}: "
            + (place / command.name / "stderr.txt").read_text().strip().rpartition("\n")[2]
            for command in todo if (place / command.name / "exit_code.txt").read_text() != "0\n"]


def table(differences: list[Difference], show_all: bool) -> str:
    """The differences, or all outputs."""
    rows = [{"output": item.output, "result": item.result,
             "remark": "" if item.result == "same" else
             (f"may differ: {item.allowed}" if item.allowed else "MUST NOT DIFFER")}
            for item in differences if show_all or item.result != "same"]
    same = sum(1 for item in differences if item.result == "same")
    text = f"{same} of {len(differences)} outputs are the same\n"
    return text + ("\n" + markdown(COLUMNS, rows) if rows else "")


def configs_of(program: Program, given: Path | None, option: str) -> Path:
    """The configs folder of a binary's own source tree."""
    if given is not None:
        return given.resolve()
    tree = source_tree(program.path)
    if tree is None:
        raise BenchError(f"{program.path} does not lie in a source tree; name its configs folder with {option}")
    return tree / "configs"


def compare(programs: list[Program], configs: list[Path], todo: list[Command], place: Path) -> list[Difference]:
    """Runs all commands with both programs and compares what they leave."""
    sides = [place / "old", place / "new"]
    do([Job(f"{side.name}  {command.name}",
            lambda program=program, folder=folder, command=command, side=side:
            run_one(program, folder, command, side), command.cost)
        for command in todo for program, folder, side in zip(programs, configs, sides)])
    return compare_folders(*sides)


def main(words: list[str]) -> int:
    """python3 -m bench compare."""
    options = parser("compare", DESCRIPTION, EXAMPLES + "\n\nwhat may differ:\n  " + "\n  ".join(
        f"{pattern:28}{reason}" for pattern, reason in MAY_DIFFER))
    options.add_argument("old", metavar="OLD_EVO_RUN")
    options.add_argument("new", metavar="NEW_EVO_RUN")
    options.add_argument("--street", type=Path, metavar="DIR", help="a further recording with ground truth")
    options.add_argument("--old-configs", type=Path, metavar="DIR", help="default: of OLD's source tree")
    options.add_argument("--new-configs", type=Path, metavar="DIR", help="default: of NEW's source tree")
    options.add_argument("--only", metavar="PATTERN", default="", help="only commands whose name this expression finds; "
                         "what they read must be among them")
    options.add_argument("--keep", type=Path, metavar="DIR", help="keep all outputs in this new folder")
    options.add_argument("--all", action="store_true", help="list the outputs that are the same, too")
    arguments = options.parse_args(words)
    if arguments.street is not None and not arguments.street.is_dir():
        raise BenchError(f"there is no folder {arguments.street}")
    if arguments.keep is not None and arguments.keep.exists():
        raise BenchError(f"{arguments.keep} is there already; name a new folder with --keep")
    programs = [find_program(arguments.old), find_program(arguments.new)]
    configs = [configs_of(programs[0], arguments.old_configs, "--old-configs"),
               configs_of(programs[1], arguments.new_configs, "--new-configs")]
    todo = [command for command in commands(arguments.street) if re.search(arguments.only, command.name)]
    with tempfile.TemporaryDirectory() as work:
        place = Path(work) if arguments.keep is None else arguments.keep.resolve()
        differences = compare(programs, configs, todo, place)
        failed = failures(place / "new", todo)
    print(table(differences, arguments.all), end="")
    for message in failed:
        print(f"failed with NEW: {message}", file=sys.stderr)
    return 1 if failed or any(item.counts for item in differences) else 0
