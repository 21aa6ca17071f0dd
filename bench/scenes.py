"""Simulated sequences: which scenes, parts and seeds, each made once and shared by all benchmarks."""
from __future__ import annotations

import json
import re
import shutil
from dataclasses import dataclass, field
from pathlib import Path
from typing import Sequence as List

from bench import targets
from bench.errors import BenchError
from bench.files import read_text, write_text
from bench.program import CONFIGS, Program
from bench.runner import KEY_FILE, Job

SIMULATED_BY = "simulated_by.json"
DRAWN_SCENE = "scene.yaml"  # of a random scene
KEPT_WHEN_DELETED = ("manifest.json", DRAWN_SCENE, KEY_FILE, SIMULATED_BY)
DRIVE_SECONDS = "8"  # of a drive without [FROM+]SECONDS
_PART = re.compile(r"(?:([0-9.]+)\+)?([0-9.]+)")


@dataclass(frozen=True)
class Part:
    """A stretch of a scene or recording, in the words of the command line."""

    start: str  # empty: at the beginning
    seconds: str

    def __str__(self) -> str:
        return f"{self.start}+{self.seconds}" if self.start else self.seconds

    @property
    def start_s(self) -> float:
        """Where it begins."""
        return float(self.start or 0)

    @property
    def end_s(self) -> float:
        """Where it ends."""
        return self.start_s + float(self.seconds)


def parse_part(text: str) -> Part:
    """[FROM+]SECONDS."""
    match = _PART.fullmatch(text)
    if not match:
        raise BenchError(f"'{text}' is not [FROM+]SECONDS")
    return Part(match[1] or "", match[2])


@dataclass(frozen=True)
class Scene:
    """A scene file and, if given, a part of it."""

    file: Path
    part: Part | None

    @property
    def name(self) -> str:
        """Its file's name without the ending."""
        return self.file.stem


def parse_scene(text: str) -> Scene:
    """SCENE[:[FROM+]SECONDS], a name in configs/scenes or the path of a scene file."""
    name, colon, part = text.partition(":")
    file = Path(name)
    if not file.is_file():
        file = CONFIGS / "scenes" / f"{name}.yaml"
    if not file.is_file():
        known = " ".join(sorted(path.stem for path in (CONFIGS / "scenes").glob("*.yaml")))
        raise BenchError(f"there is no scene {name}; there are {known}")
    return Scene(file, parse_part(part) if colon else None)


def read_parameters(yaml: str) -> dict[str, str]:
    """All parameters that `--print` writes, by their full names: two levels of indentation, a comment behind each."""
    parameters: dict[str, str] = {}
    groups: list[str] = []
    for line in yaml.splitlines():
        match = re.match(r"( *)([\w.]+):(?: (.*?))?(?:  # .*)?$", line)
        if not match:
            continue
        depth = len(match[1]) // 2
        groups = groups[:depth] + [match[2]]
        if match[3] is not None:
            parameters[".".join(groups)] = match[3]
    return parameters


@dataclass(frozen=True)
class Sequence:
    """A simulated sequence in its folder, there already or still to be made."""

    scene: Scene
    seed: str
    part: Part
    folder: Path
    made_from: str  # what it depends on
    arguments: tuple[str, ...]  # of `simulate`, without --out

    @property
    def name(self) -> str:
        """SCENE_SEED_PART."""
        return f"{self.scene.name}_{self.seed}_{self.part}"

    @property
    def label(self) -> str:
        """SCENE:PART."""
        return f"{self.scene.name}:{self.part}"

    def is_made(self) -> bool:
        """Whether the folder was made from the same; after --delete its events may be gone."""
        return read_text(self.folder / KEY_FILE) == self.made_from

    def has_events(self) -> bool:
        """Whether the events are there."""
        return any(self.folder.glob("*_data.hdf5")) or (self.folder / "events.txt").exists()

    def delete_events(self) -> None:
        """Deletes everything but what tells that results are still of this sequence."""
        for path in sorted(self.folder.rglob("*"), reverse=True):
            if path.is_file() and path.name not in KEPT_WHEN_DELETED:
                path.unlink()
            elif path.is_dir():
                path.rmdir()


@dataclass(frozen=True)
class Simulator:
    """Makes sequences in a folder, with parameters that differ from the scenes' own."""

    program: Program
    folder: Path
    settings: tuple[str, ...] = ()  # NAME=VALUE
    drive_seconds: str = DRIVE_SECONDS
    workers: int = 1  # simulations at a time
    _parameters: dict = field(default_factory=dict, compare=False, repr=False)

    def parameters(self, scene: Scene, seed: str) -> dict[str, str]:
        """All parameters of a scene."""
        key = (scene.file, seed)
        if key not in self._parameters:
            arguments = ["simulate", str(scene.file), "--seed", seed, *self._settings()]
            self._parameters[key] = read_parameters(self.program.output(*arguments, "--print"))
        return self._parameters[key]

    def sequence(self, scene: Scene, seed: str) -> Sequence:
        """The sequence of a scene and seed: vehicles in MVSEC's layout, others in UZH's."""
        parameters = self.parameters(scene, seed)
        kind = parameters[targets.MOTION_KIND]
        is_drive = kind == "vehicle"
        whole = self.drive_seconds if is_drive else parameters.get(f"motion.{kind}.duration_s", self.drive_seconds)
        part = scene.part or Part("", whole)
        format_ = "mvsec" if is_drive else "uzh"
        lines = [f"{name}: {value}" for name, value in sorted(parameters.items())]
        made_from = "\n".join([*lines, f"part: {part}, format: {format_}"]) + "\n"
        arguments = ["simulate", str(scene.file), "--seed", seed, *self._settings()]
        if part.start:
            arguments += ["--from", part.start]
        arguments += ["--duration", part.seconds, "--format", format_]
        folder = self.folder / f"{scene.name}_{seed}_{part}"
        return Sequence(scene, seed, part, folder, made_from, tuple(arguments))

    def job(self, sequence: Sequence) -> Job:
        """The job that makes a sequence."""
        return Job(f"simulate   {sequence.folder}", lambda: self.make(sequence), float(sequence.part.seconds))

    def missing(self, sequences: List[Sequence], resimulate: bool = False) -> list[Job]:
        """The jobs of those sequences that are not there, each once."""
        chosen = {sequence.folder: sequence for sequence in sequences
                  if resimulate or not sequence.is_made() or not sequence.has_events()}
        return [self.job(sequence) for sequence in chosen.values()]

    def make(self, sequence: Sequence) -> None:
        """Simulates a sequence. A folder of somebody else is refused and left alone."""
        folder = sequence.folder
        if folder.exists() and any(folder.iterdir()) and not (folder / KEY_FILE).exists():
            raise BenchError(f"{folder}: was not made by a benchmark and is left alone; "
                             "choose another folder with --sequences")
        shutil.rmtree(folder, ignore_errors=True)
        write_text(folder / KEY_FILE, "")  # filled at the end; tells already now that the folder is ours
        self.program.output(*sequence.arguments, "--out", str(folder), "--quiet")
        by = {"program": self.program.checksum, "at_a_time": self.workers}
        write_text(folder / SIMULATED_BY, json.dumps(by) + "\n")
        write_text(folder / KEY_FILE, sequence.made_from)

    def _settings(self) -> list[str]:
        return [word for setting in self.settings for word in ("--set", setting)]


def simulated_by(folder: Path) -> dict:
    """Which program made a sequence and how many were made at a time; empty where that is not known."""
    text = read_text(folder / SIMULATED_BY)
    return {} if text is None else json.loads(text)
