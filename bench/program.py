"""The program that is measured, told apart from other builds by its checksum."""
from __future__ import annotations

import hashlib
import os
import platform
import subprocess
import sys
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from bench.errors import BenchError

ROOT = Path(__file__).resolve().parent.parent
CONFIGS = ROOT / "configs"


@dataclass(frozen=True)
class Program:
    """evo-run of one build."""

    path: Path

    @cached_property
    def checksum(self) -> str:
        """SHA-256 of the file."""
        return hashlib.sha256(self.path.read_bytes()).hexdigest()

    @cached_property
    def version(self) -> str:
        """What --version says."""
        return self.output("--version").strip()

    def output(self, *arguments: str) -> str:
        """The stdout of a call; a failure becomes a BenchError with the program's message."""
        result = subprocess.run([str(self.path), *arguments], capture_output=True, text=True, check=False)
        if result.returncode != 0:
            raise BenchError(error_message(result.stderr) or f"{self.path} ended with {result.returncode}")
        return result.stdout

    @cached_property
    def source_state(self) -> str:
        """The commit of the source tree that the program lies in, and how far it can be trusted."""
        return source_state(self.path)


def error_message(stderr: str) -> str:
    """The last error that evo-run reports."""
    prefix = "evo-run: error: "
    found = [line[len(prefix):] for line in stderr.splitlines() if line.startswith(prefix)]
    return found[-1] if found else ""


def find_program(given: str | None = None) -> Program:
    """The program named, that of the environment's EVO_RUN, or the release build brought up to date."""
    name = given or os.environ.get("EVO_RUN")
    path = Path(name) if name else _release_build()
    if not path.is_file() or not os.access(path, os.X_OK):
        raise BenchError(f"{path} is not a program; correct EVO_RUN")
    return Program(path.resolve())


def _release_build() -> Path:
    """build/release/bin/evo-run of this repository, built where it is out of date."""
    folder = ROOT / "build" / "release"
    if (folder / "build.ninja").exists():
        command = ["cmake", "--build", str(folder), "--target", "evo-run"]
    else:
        command = [str(ROOT / "scripts" / "setup.sh")]
    if subprocess.run(command, stdout=sys.stderr, check=False).returncode != 0:
        raise BenchError("the program cannot be built; see above, or name one in EVO_RUN")
    return folder / "bin" / "evo-run"


def source_tree(binary: Path) -> Path | None:
    """The source tree that a binary lies in: the nearest folder above it with configs/default.yaml."""
    for folder in binary.resolve().parents:
        if (folder / "configs" / "default.yaml").is_file() and (folder / "src").is_dir():
            return folder
    return None


def source_state(binary: Path) -> str:
    """The commit of a binary's source tree; uncommitted changes and sources newer than the binary are said."""
    tree = source_tree(binary)
    if tree is None:
        return "unknown commit"
    commit = _git(tree, "rev-parse", "--short=10", "HEAD")
    if not commit:
        return "unknown commit"
    if _git(tree, "status", "--porcelain", "--", "src", "include", "CMakeLists.txt", "cmake"):
        commit += " with uncommitted changes"
    built = binary.stat().st_mtime
    sources = (path for folder in ("src", "include") for path in (tree / folder).rglob("*") if path.is_file())
    if any(path.stat().st_mtime > built for path in sources):
        commit += " (sources are newer than the program)"
    return commit


def _git(tree: Path, *arguments: str) -> str:
    """The stdout of git, or nothing."""
    try:
        result = subprocess.run(["git", "-C", str(tree), *arguments], capture_output=True, text=True, check=False)
    except FileNotFoundError:
        return ""
    return result.stdout.strip() if result.returncode == 0 else ""


def describe_machine() -> str:
    """Processor and number of cores that this process may use."""
    model = platform.machine()
    try:
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                model = line.partition(":")[2].strip()
                break
    except OSError:
        pass
    return f"{model}, {len(os.sched_getaffinity(0))} cores"
