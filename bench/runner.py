"""Running commands and keeping their results: only what is missing or out of date is done."""
from __future__ import annotations

import shutil
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from threading import Lock
from typing import Callable, Sequence, TextIO

from bench.errors import BenchError
from bench.files import read_text, write_text
from bench.program import Program, error_message

KEY_FILE = "made_from.txt"
MARKS = ("complete", "failure.txt", "started")


def key_of(program: Program, arguments: Sequence[str], *inputs: str) -> str:
    """What results depend on: the build, the arguments and the identity of the inputs."""
    return "\n".join([program.checksum, " ".join(arguments), *inputs]) + "\n"


def identity(folder: Path) -> str:
    """What tells a sequence or recording from another one in the same place."""
    made_from = read_text(folder / KEY_FILE)
    if made_from is not None:
        return made_from.rstrip("\n")
    files = sorted(path for path in folder.iterdir() if path.is_file())
    return "\n".join(f"{path.name} {path.stat().st_size} {path.stat().st_mtime_ns}" for path in files)


def is_done(results: Path, key: str) -> bool:
    """Whether results were made from exactly that."""
    return read_text(results / KEY_FILE) == key


def mark_done(results: Path, key: str) -> None:
    """Notes what results were made from; without the note they are made again."""
    write_text(results / KEY_FILE, key)


def run_into(results: Path, program: Program, arguments: Sequence[str]) -> bool:
    """Runs a command with --out RESULTS, emptied first, and returns whether it succeeded.

    RESULTS then holds `complete`, or failure.txt, which says why; log.txt is the command's stderr.
    """
    clear(results)
    (results / "started").touch()
    command = [str(program.path), *arguments, "--out", str(results)]
    with open(results / "output.txt", "wb") as output, open(results / "log.txt", "wb") as log:
        process = subprocess.Popen(command, stdout=output, stderr=log)
        try:
            code = process.wait()
        except BaseException:
            process.terminate()
            process.wait()
            shutil.rmtree(results, ignore_errors=True)
            raise
    if code == 0:
        (results / "started").rename(results / "complete")
        return True
    message = error_message((results / "log.txt").read_text(errors="replace")) or "no message, see log.txt"
    write_text(results / "failure.txt", f"exit code {code}: {message}\n")
    (results / "started").unlink()
    print(f"failed     {results}: exit code {code}: {message}", file=sys.stderr)
    return False


def clear(results: Path) -> None:
    """Empties a folder of earlier results. A folder with other contents is refused and left alone."""
    if results.exists() and any(results.iterdir()) and not any((results / mark).exists() for mark in MARKS):
        raise BenchError(f"{results}: this folder does not hold results of a benchmark and is left alone; "
                         "choose another --out")
    shutil.rmtree(results, ignore_errors=True)
    results.mkdir(parents=True)


@dataclass(frozen=True)
class Job:
    """A piece of work with the text that announces it and its expected cost in any unit."""

    text: str
    action: Callable[[], object]
    cost: float = 1.0


class Progress:
    """Announces jobs; on a terminal with their number and an estimate of the time left."""

    def __init__(self, jobs: Sequence[Job], stream: TextIO | None = None,
                 clock: Callable[[], float] = time.monotonic) -> None:
        self._total = len(jobs)
        self._cost_left = sum(job.cost for job in jobs)
        self._cost_done = 0.0
        self._started = 0
        self._stream = stream or sys.stderr
        self._clock = clock
        self._begin = clock()
        self._lock = Lock()

    def start(self, job: Job) -> None:
        """Announces a job."""
        with self._lock:
            self._started += 1
            line = job.text
            if self._stream.isatty():
                line = f"[{self._started}/{self._total}{self._estimate()}] {line}"
            print(line, file=self._stream, flush=True)

    def finish(self, job: Job) -> None:
        """Counts a job as done."""
        with self._lock:
            self._cost_done += job.cost
            self._cost_left -= job.cost

    def _estimate(self) -> str:
        """The time left, from the cost done so far."""
        if self._cost_done <= 0:
            return ""
        seconds = (self._clock() - self._begin) * self._cost_left / self._cost_done
        return f", about {seconds / 60:.0f} min left" if seconds >= 90 else f", about {seconds:.0f} s left"


def do(jobs: Sequence[Job], workers: int = 1) -> None:
    """Does all jobs, `workers` at a time. What is timed needs one worker."""
    progress = Progress(jobs)

    def work(job: Job) -> None:
        progress.start(job)
        job.action()
        progress.finish(job)

    if workers <= 1:
        for job in jobs:
            work(job)
        return
    with ThreadPoolExecutor(workers) as pool:
        futures = [pool.submit(work, job) for job in jobs]
        try:
            for future in futures:
                future.result()
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise
