"""Comparing two builds."""
from __future__ import annotations

import unittest
from pathlib import Path

from support import BenchTest

from bench import compare_builds
from bench.compare_commands import commands


class Compare(BenchTest):
    def setUp(self) -> None:
        super().setUp()
        for name in ("default", "paper"):
            self.write(f"configs/{name}.yaml", "")
        self.configs = ["--old-configs", "configs", "--new-configs", "configs"]

    def folders(self, old: dict[str, str], new: dict[str, str]) -> dict[str, tuple[str, bool]]:
        for side, files in (("old", old), ("new", new)):
            for name, text in files.items():
                self.write(f"{side}/{name}", text)
        found = compare_builds.compare_folders(Path("old"), Path("new"))
        return {item.output: (item.result, item.counts) for item in found}

    def test_one_byte(self) -> None:
        found = self.folders({"run/tracks.txt": "1 2 3", "run/map.ply": "x", "run/manifest.json": "1", "gone.csv": ""},
                             {"run/tracks.txt": "1 2 4", "run/map.ply": "x", "run/manifest.json": "2", "more.csv": ""})
        self.assertEqual(found, {"run/tracks.txt": ("differs", True), "run/map.ply": ("same", False),
                                 "run/manifest.json": ("differs", False), "gone.csv": ("only in OLD", True),
                                 "more.csv": ("only in NEW", True)})

    def test_the_same_build(self) -> None:
        self.assertEqual(self.bench("compare", str(self.fake), str(self.fake), *self.configs), 0, self.out + self.err)
        self.assertIn("outputs are the same", self.out)
        self.assertNotIn("MUST NOT DIFFER", self.out)

    def test_another_build(self) -> None:
        other = self.write_fake("other/evo-run", build="two")
        self.assertEqual(self.bench("compare", str(self.fake), str(other), *self.configs, "--only", "street"), 1)
        self.assertRegex(self.out, r"track_street/stdout.txt +\| differs \| MUST NOT DIFFER")
        other.write_text(other.read_text().replace('"1 0.0 5 5', '"1 0.0 5 6').replace('"two"', '"one"'))
        self.assertEqual(self.bench("compare", str(self.fake), str(other), *self.configs, "--only", "street"), 1)
        self.assertRegex(self.out, r"run_street_1/tracks.txt +\| differs \| MUST NOT DIFFER")

    def test_commands_that_fail_are_told(self) -> None:
        self.set_environment("FAKE_EXIT", "4")
        self.assertEqual(self.bench("compare", str(self.fake), str(self.fake), *self.configs, "--only", "run_night"), 1)
        self.assertIn("failed with NEW: run_night_1: exit code 4: evo-run: error: tracking is lost", self.err)

    def test_names_are_different(self) -> None:
        names = [command.name for command in commands(Path("street"))]
        self.assertEqual(len(names), len(set(names)))


if __name__ == "__main__":
    unittest.main()
