"""Options that the benchmarks share, checked before anything is done."""
from __future__ import annotations

import argparse
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import NoReturn

from bench.errors import BenchError
from bench.program import Program, find_program
from bench.recordings import Recording, parse_recording
from bench.scenes import Scene, Simulator, parse_scene


class Parser(argparse.ArgumentParser):
    """A parser whose errors are one line."""

    def error(self, message: str) -> NoReturn:
        raise BenchError(f"{message}; see --help")


def parser(name: str, description: str, examples: str) -> Parser:
    """A parser whose help ends with examples."""
    return Parser(prog=f"python3 -m bench {name}", description=description, epilog=examples, allow_abbrev=False,
                  formatter_class=argparse.RawDescriptionHelpFormatter)


def list_of(pattern: str):
    """The type of a comma-separated list whose members match a pattern."""
    def parse(text: str) -> list[str]:
        values = text.split(",")
        if not all(re.fullmatch(pattern, value) for value in values):
            raise argparse.ArgumentTypeError(f"cannot be '{text}'")
        return values
    return parse


def positive(text: str) -> int:
    """The type of a whole number from 1 on."""
    if not re.fullmatch(r"[1-9][0-9]*", text):
        raise argparse.ArgumentTypeError(f"cannot be '{text}': a number from 1 on")
    return int(text)


def name_value(text: str) -> str:
    """The type of NAME=VALUE."""
    if not re.fullmatch(r"[^=\s]+=.*", text):
        raise argparse.ArgumentTypeError(f"cannot be '{text}': NAME=VALUE")
    return text


def add_scenes(to: Parser, default: list[str] | None) -> None:
    """Scenes, seeds and where the sequences are."""
    shown = "all scenes of configs/scenes" if default is None else " ".join(default)
    to.add_argument("scenes", nargs="*", metavar="SCENE[:[FROM+]SECONDS]",
                    help=f"a name in configs/scenes or a scene file, and a part of it; default: {shown}")
    to.add_argument("--seeds", type=list_of("[0-9]+"), default=["1", "2", "3"], metavar="LIST",
                    help="of the scenes, between commas; default 1,2,3")
    to.add_argument("--sequences", type=Path, default=Path("out/scenes"), metavar="DIR",
                    help="simulated sequences; default out/scenes")


def add_recordings(to: Parser) -> None:
    """Recordings beside the scenes."""
    to.add_argument("--recording", action="append", default=[], metavar="FOLDER[:[FROM+]SECONDS]", dest="recordings",
                    help="also this recording, in MVSEC's or UZH's layout; may be repeated; without scenes: only these")


def add_common(to: Parser, out: str) -> None:
    """Threads, workers, the folder for the results and the program."""
    to.add_argument("--threads", type=positive, default=2, metavar="N", help="of each run; default 2")
    to.add_argument("--jobs", type=positive, default=1, metavar="N",
                    help="simulations and evaluations at a time; what is timed runs alone; default 1")
    to.add_argument("--out", type=Path, default=Path(out), metavar="DIR", help=f"default {out}")
    to.add_argument("--evo-run", metavar="FILE",
                    help="the program; default: EVO_RUN, else build/release/bin/evo-run brought up to date")


@dataclass
class Bench:
    """What every benchmark is called with."""

    program: Program
    out: Path
    threads: int
    jobs: int
    command: list[str]  # the command line, for the record
    seeds: list[str] = field(default_factory=list)
    scenes: list[Scene] = field(default_factory=list)
    recordings: list[Recording] = field(default_factory=list)
    sequences: Path = Path("out/scenes")

    def simulator(self, settings: tuple[str, ...] = (), subfolder: str = "", **others) -> Simulator:
        """A simulator into the folder of sequences or one in it."""
        return Simulator(self.program, self.sequences / subfolder, settings, workers=self.jobs, **others)


def bench_of(arguments: argparse.Namespace, name: str, words: list[str], default_scenes: list[str]) -> Bench:
    """The checked arguments; scenes and recordings that are not there are refused."""
    recordings = [parse_recording(text) for text in getattr(arguments, "recordings", [])]
    named = getattr(arguments, "scenes", []) or ([] if recordings else default_scenes)
    scenes = [parse_scene(text) for text in named]
    return Bench(find_program(arguments.evo_run), arguments.out, arguments.threads, arguments.jobs, [name, *words],
                 getattr(arguments, "seeds", []), scenes, recordings, getattr(arguments, "sequences", Path("out/scenes")))
