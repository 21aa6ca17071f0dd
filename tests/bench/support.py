"""What the tests of the benchmarks share: a folder of their own and a tiny evo-run that only writes the usual files."""
from __future__ import annotations

import contextlib
import csv
import io
import os
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from bench.__main__ import main  # noqa: E402

# Reads what it is to do from FAKE_EXIT (exit code of track, run and odometry) and counts its calls in calls.txt.
FAKE = '''#!/usr/bin/env python3
import json, os, sys
from pathlib import Path
BUILD = "one"
words = sys.argv[1:]
command = words[0]
value = lambda name: words[words.index(name) + 1] if name in words else None
out = Path(value("--out") or ".")
with open(Path(__file__).with_name("calls.txt"), "a") as calls:
    calls.write(" ".join(words) + "\\n")
if command == "--version":
    print("evo-run fake"); sys.exit(0)
if "--print" in words:
    if command == "config":
        sys.exit(0)
    print("scene:\\n  seed: %s  # of chance\\nmotion:\\n  kind: slider  # how\\n\\n  slider:\\n    duration_s: 0.3  # s\\n"
          "  vehicle:\\n    bumps_at_s: 52,56  # s\\n    camera_height_m: 1.6  # m\\nsensor:\\n  threshold_on: 0.5\\n  threshold_off: 0.2\\n"
          "  threshold_spread: 0.03" % value("--seed"))
    sys.exit(0)
if command in ("track", "run", "odometry") and os.environ.get("FAKE_EXIT", "0") != "0":
    print("info: begin\\nevo-run: error: tracking is lost, it seems", file=sys.stderr); sys.exit(int(os.environ["FAKE_EXIT"]))
out.mkdir(parents=True, exist_ok=True)
name = Path(value("--events") or "").name.split("_")
seed = int(name[-2]) if len(name) > 2 and name[-2].isdigit() else 0
manifest = {"counts": {"events": 1000, "positive_events": 400, "track_observations": 200, "event_frames": 10,
                       "frames_lost": 0},
            "rebootstraps": [], "scale": "ground" if "odometry.ground.camera_height_m=1.6" in words else "arbitrary", "wall_time_s": {"track": 0.1 * seed, "write_tracks": 0.0, "odometry": 0.05,
            "simulate": 1.0, "read": 0.1, "evaluate": 0.2, "write": 0.3}, "recorded_s": 1.0, "cpu_time_s": 0.2,
            "peak_memory_mb": 50.0, "parameters": {"output": {"start_s": 100}}}
(out / "manifest.json").write_text(json.dumps(manifest))
if command == "simulate":
    (out / "events.txt").write_text("0 1 1 1\\n"); (out / "groundtruth.txt").write_text("0 0 0 0 0 0 0 1\\n")
    (out / "calib.txt").write_text("1 1 1 1\\n")
if command in ("track", "run"):
    (out / "tracks.txt").write_text("1 0.0 5 5\\n1 1.0 6 5\\n")
    (out / "lifetime.csv").write_text("quantity,unit,bin_low,bin_high,value\\nframe_interval,s,,,0.02\\n"
                                      "mean,frames,,,%d\\nmean,s,,,0.8\\n" % (30 + 10 * seed))
if command in ("run", "odometry"):
    (out / "trajectory.txt").write_text("0.0 0 0 0 0 0 0 1\\n0.4 0 0 0 0 0 0 1\\n1.0 0 0 0 0 0 0 1\\n")
if command in ("run", "evaluate"):
    (out / "summary.csv").write_text("alignment,scale,path_m,coverage,rebootstraps,mean_planar_percent,"
        "max_planar_percent\\norigin-scale,2,10,1,0,%g,1\\nsim3,2,10,1,0,0.05,0.5\\n" % (0.1 * seed))
if command == "evaluate" and "--tracks" in words:
    (out / "track_quality.csv").write_text("quantity,unit,threshold_px,age_low_s,age_high_s,value\\n"
        "truth,name,,,,depth\\ntracks,count,,,,10\\ntracks_judged,count,,,,8\\ntracks_moves,count,,,,1\\n"
        "track_error_median,px,,,,0.4\\ncompared_positions,count,3.000000000,,,90\\n"
        "compared_positions,count,,,,100\\nexceeding_share,share,3.000000000,,,0.125\\n")
print("done by", BUILD)
'''


class BenchTest(unittest.TestCase):
    """A folder of its own as the working folder, with a fake evo-run."""

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name).resolve()
        before = os.getcwd()
        self.addCleanup(os.chdir, before)
        os.chdir(self.folder)
        self.fake = self.write_fake("fake/evo-run")
        for name, value in (("EVO_RUN", str(self.fake)), ("FAKE_EXIT", "0")):
            self.set_environment(name, value)

    def set_environment(self, name: str, value: str) -> None:
        """Sets a variable for the test."""
        before = os.environ.get(name)
        os.environ[name] = value
        self.addCleanup(os.environ.__setitem__ if before is not None else os.environ.pop, name, before)

    def write(self, name: str, text: str) -> Path:
        """Writes a file in the folder."""
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path

    def write_fake(self, name: str, build: str = "one") -> Path:
        """Writes a fake evo-run."""
        path = self.write(name, FAKE.replace('BUILD = "one"', f'BUILD = "{build}"'))
        path.chmod(0o755)
        return path

    def write_scene(self, name: str, duration_s: str = "0.3", length_m: str = "0.3") -> None:
        """Writes a slider that is fast and short."""
        self.write(f"{name}.yaml", "scene:\n  kind: slider\n  calibration: davis240c\nmotion:\n  kind: slider\n"
                   f"  slider:\n    duration_s: {duration_s}\n    length_m: {length_m}\n"
                   "simulation:\n  samples: 1\n  image_hz: 0\n")

    def bench(self, *words: str) -> int:
        """Runs a benchmark; keeps what it prints."""
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = main(list(words))
        self.out, self.err = out.getvalue(), err.getvalue()
        return code

    def done(self, what: str) -> int:
        """How many jobs of a kind the last call announced."""
        return sum(1 for line in self.err.splitlines() if line.startswith(what + " "))

    def table(self, name: str) -> list[dict[str, str]]:
        """The rows of a CSV file."""
        with open(self.folder / name, newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))
