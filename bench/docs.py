"""docs/benchmarks.md from the tables of one build."""
from __future__ import annotations

import json
import shutil
import sys
from pathlib import Path
from typing import Any

from bench import all_benchmarks
from bench.files import read_text, write_text
from bench.options import parser
from bench.program import ROOT, Program, find_program
from bench.record import TARGET_COLUMNS
from bench.tables import markdown
from bench.targets import PUBLISHED_ODOMETRY

DESCRIPTION = """\
Writes docs/benchmarks.md from what the benchmarks have measured with one build, the program's own. Tables of other
builds are left out, and the page says so; --check writes nothing and fails if any table is missing or of another
build."""
EXAMPLES = """\
examples:
  python3 -m bench all --quick && python3 -m bench docs
  python3 -m bench docs --results /data/out --to /tmp/benchmarks.md"""
TITLES = {
    "tracking": "Tracking",
    "odometry": "Odometry",
    "ablation": "What the odometry is made of",
    "scaling": "Time and memory of the tracker",
    "scenes": "Scenes",
    "worlds": "Random worlds",
    "evaluation": "Evaluation",
}
ABOUT = {
    "tracking": "`em` is the tracker, `klt` the baseline: pyramidal KLT on event images (`tracker.method=klt`).",
    "odometry": "`ours` is the default configuration, `paper` is configs/paper.yaml, the system as the paper describes "
                "it, `tracker.method=klt` is ours on the baseline's tracks. In parentheses: the worst of the seeds.",
    "ablation": "Each row switches one ingredient off. In parentheses: the worst of the seeds.",
    "scaling": "One scene and seed. With `thresholds_...` the sensor's thresholds are that share of the scene's.",
    "scenes": "What the simulated sequences are like, what they cost, and how they are followed.",
    "worlds": "Drives that are drawn at random, see [simulation.md](simulation.md#random-scenes). 90 %: nine of ten drives "
              "are as good or better.",
    "evaluation": "Poses at 20 Hz along a drive.",
}
Record = dict[str, Any]


def record_file(results: Path, name: str) -> Path:
    """Where a benchmark keeps its tables."""
    return results / all_benchmarks.FOLDERS[name] / f"{name}.json"


def records_of(results: Path, program: Program) -> tuple[dict[str, Record], dict[str, str]]:
    """The records of the program's own build, and of the others why they are left out."""
    records: dict[str, Record] = {}
    missing: dict[str, str] = {}
    for name in TITLES:
        text = read_text(record_file(results, name))
        if text is None:
            missing[name] = "it has not been run"
            continue
        record = json.loads(text)
        if record["program"] == program.checksum:
            records[name] = record
        else:
            missing[name] = f"its last results are of another build, {record['program'][:12]}"
    return records, missing


def command_line(words: list[str]) -> str:
    """The command that measures a table again, without where its files are."""
    hidden = {"--out", "--sequences", "--evo-run"}
    shown = [word for i, word in enumerate(words) if word not in hidden and (i == 0 or words[i - 1] not in hidden)]
    return "python3 -m bench " + " ".join(f'"{word}"' if " " in word else word for word in shown)


def each(records: dict[str, Record], name: str) -> str:
    """The values of a field in all records, each once."""
    values = dict.fromkeys(str(record[name]) for record in records.values())
    return "; ".join(values)


def in_ranges(seeds: list[str]) -> str:
    """Seeds between commas, three and more in a row as a range."""
    runs: list[list[int]] = []
    for seed in map(int, seeds):
        if runs and seed == runs[-1][-1] + 1:
            runs[-1].append(seed)
        else:
            runs.append([seed])
    return ", ".join(f"{run[0]}-{run[-1]}" if len(run) > 2 else ", ".join(map(str, run)) for run in runs)


def stamp(records: dict[str, Record], program: Program) -> str:
    """Build, machine and days."""
    days = sorted(day for record in records.values() for day in record["measured"])
    seeds = "; ".join(f"{name} {in_ranges(record['seeds'])}" for name, record in records.items() if record["seeds"])
    period = " to ".join(dict.fromkeys([days[0], days[-1]])) if days else "-"
    lines = [
        ("commit", each(records, "commit") or program.source_state),
        ("program", f"{program.version}, SHA-256 {program.checksum[:12]}"),
        ("machine", each(records, "machine") or "-"),
        ("threads of a run", each(records, "threads") or "-"),
        ("measured", period),
        ("seeds", seeds or "-"),
    ]
    return "| | |\n|---|---|\n" + "".join(f"| {name} | {value} |\n" for name, value in lines)


def target_summary(records: dict[str, Record]) -> str:
    """All targets beside what was measured."""
    rows = [row for record in records.values() for row in record["targets"]]
    if not rows:
        return "No scene with targets was measured with this build.\n"
    met = sum(1 for row in rows if row["result"].startswith("met"))
    unknown = sum(1 for row in rows if row["result"].startswith("not measured"))
    return (f"{met} of {len(rows)} met, {len(rows) - met - unknown} missed, {unknown} not measured. All targets stand in "
            f"bench/targets.py; here are those of the scenes that were measured.\n\n{markdown(TARGET_COLUMNS, rows)}")


def chapter(name: str, record: Record, figures: list[str]) -> str:
    """The tables of a benchmark."""
    parts = [f"## {TITLES[name]}", ABOUT[name], f"`{command_line(record['command'])}`"]
    if record["failed"]:
        parts.append("**Some runs failed**; their cells are empty.")
    if record["other_simulators"]:
        parts.append("Some sequences were simulated by another build: " + ", ".join(record["other_simulators"]) + ".")
    explained: dict[str, str] = {}
    for section in record["sections"]:
        parts.append("\n\n".join(text for text in (f"**{section['title']}**", section["note"]) if text))
        parts.append(section["table"].rstrip("\n"))
        explained.update({title: meaning for title, meaning in section["columns"]})
    if explained:
        parts.append("\n".join(f"- *{title}*: {meaning}" for title, meaning in explained.items()))
    parts += [f"![{name}: {Path(figure).stem}]({figure})" for figure in figures]
    return "\n\n".join(parts) + "\n"


def published() -> str:
    """The paper's own figures."""
    values = PUBLISHED_ODOMETRY
    return (f"The paper's own figures on MVSEC outdoor_day2 (439 m, origin-scale, its table 3): mean error longitudinal "
            f"{values['mean_longitudinal_m']} m, lateral {values['mean_lateral_m']} m, planar "
            f"{values['mean_planar_m']} m, which is {values['mean_planar_percent']} % of the path; largest "
            f"{values['max_planar_percent']} %. The scene like it is `driving_day:60`.\n")


def copy_figures(results: Path, name: str, record: Record, page: Path) -> list[str]:
    """Copies a benchmark's figures beside the page and returns the links."""
    links = []
    for figure in record["figures"]:
        source = record_file(results, name).parent / figure
        if source.exists():
            target = page.parent / "figures" / f"bench_{figure}"
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(source, target)
            links.append(f"figures/{target.name}")
    return links


def page_text(results: Path, program: Program, page: Path) -> str:
    """The whole page."""
    records, missing = records_of(results, program)
    parts = ["# Benchmarks\n",
             "Written by `python3 -m bench docs`; every figure is of the one build below. Do not edit by hand.\n",
             stamp(records, program), "## Targets\n", target_summary(records)]
    for name, title in TITLES.items():
        if name in missing:
            parts.append(f"## {title}\n\nNot measured with this build: {missing[name]}. "
                         f"To measure it: `python3 -m bench {name}`.\n")
        else:
            parts.append(chapter(name, records[name], copy_figures(results, name, records[name], page)))
        if name == "odometry":
            parts.append(published())
    return "\n".join(parts)


def main(words: list[str]) -> int:
    """python3 -m bench docs."""
    options = parser("docs", DESCRIPTION, EXAMPLES)
    options.add_argument("--results", type=Path, default=Path("out"), metavar="DIR",
                         help="folder of the benchmarks' results; default out")
    options.add_argument("--to", type=Path, default=ROOT / "docs" / "benchmarks.md", metavar="FILE",
                         help="the page; default docs/benchmarks.md")
    options.add_argument("--check", action="store_true", help="only say which tables are not of this build")
    options.add_argument("--evo-run", metavar="FILE", help="the program; default: EVO_RUN, else the release build")
    arguments = options.parse_args(words)
    program = find_program(arguments.evo_run)
    records, missing = records_of(arguments.results, program)
    for name, reason in missing.items():
        print(f"{name}: not measured with this build: {reason}", file=sys.stderr)
    if arguments.check:
        return 1 if missing else 0
    if not records:
        print("nothing was measured with this build; the page is left as it is", file=sys.stderr)
        return 1
    write_text(arguments.to, page_text(arguments.results, program, arguments.to))
    print(arguments.to)
    return 0
