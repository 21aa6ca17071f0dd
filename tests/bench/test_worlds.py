"""The random worlds with a fake evo-run: rows, distribution, the worst, resumption, held-back seeds."""
from __future__ import annotations

import argparse
import unittest

from support import BenchTest

from bench.measures import resting_share
from bench.worlds import seed_list
from bench.worlds_table import distribution, percentile, row_of

WORLDS = ("worlds", "--scene", "swift.yaml", "--duration", "0.3")


class Worlds(BenchTest):
    def setUp(self) -> None:
        super().setUp()
        self.write_scene("swift")

    def test_rows_distribution_and_the_worst(self) -> None:
        self.assertEqual(self.bench(*WORLDS, "--seeds", "1-3", "--worst", "2"), 0, self.err)
        rows = self.table("out/bench_worlds/worlds.csv")
        self.assertEqual([row["seed"] + row["method"] for row in rows], ["1em", "1klt", "2em", "2klt", "3em", "3klt"])
        self.assertEqual([row["mean_planar_percent"] for row in rows[::2]], ["0.1", "0.2", "0.3"])
        self.assertEqual(rows[0]["lost"], "1", "the poses are 0.6 s apart")
        self.assertEqual((rows[0]["has_metric_scale"], rows[0]["metric_scale_error_percent"]), ("1", "100"))
        self.assertIn("3 random drives of 0.3 s", self.out)
        self.assertRegex(self.out, r"mean planar, % +\| 0.200 +\| 0.300 +\| 0.300 +\| 3 ")
        worst = self.out[self.out.index("The worst drives"):self.out.index("Targets")].splitlines()
        self.assertEqual([line.split("|")[1].strip() for line in worst[2:6] if "|" in line], ["seed", "-" * 6, "3", "2"])
        self.assertRegex(self.out, r"mean_planar_percent +\| median +\| <= 0.08 +\| - +\| 0.2 +\| missed")

    def test_events_are_deleted_and_only_what_is_missing_is_done(self) -> None:
        words = (*WORLDS, "--seeds", "1,2", "--methods", "em")
        self.assertEqual(self.bench(*words), 0, self.err)
        self.assertEqual(self.done("world"), 2)
        kept = sorted(path.name for path in (self.folder / "out/worlds/swift_1_0.3").iterdir())
        self.assertEqual(kept, ["made_from.txt", "manifest.json", "simulated_by.json"])
        before = self.out
        self.assertEqual(self.bench(*words), 0)
        self.assertEqual((self.out, self.err), (before, ""), "nothing to do, and the same said")
        self.bench(*words, "--seeds", "1-3")
        self.assertEqual(self.done("world"), 1)
        self.bench(*words, "--set", "tracker.features=100", "--keep")
        self.assertEqual(self.done("world"), 2)
        self.assertTrue((self.folder / "out/worlds/swift_1_0.3/events.txt").exists())

    def test_the_odometry_runs_again_with_the_cameras_height(self) -> None:
        self.bench(*WORLDS, "--seeds", "1", "--methods", "em")
        calls = (self.folder / "fake/calls.txt").read_text().splitlines()
        self.assertTrue(any(line.startswith("odometry") and "odometry.ground.camera_height_m=1.6" in line
                            for line in calls))

    def test_a_failure_is_a_lost_drive(self) -> None:
        self.set_environment("FAKE_EXIT", "6")
        self.assertEqual(self.bench(*WORLDS, "--seeds", "1", "--methods", "klt"), 0)
        row = self.table("out/bench_worlds/worlds.csv")[0]
        self.assertEqual((row["lost"], row["mean_planar_percent"]), ("1", ""))
        self.assertIn("tracking is lost", row["failure"])

    def test_a_trajectory_that_no_scale_fits_is_lost(self) -> None:
        results = self.folder / "results"
        results.mkdir()
        (results / "trajectory.txt").write_text("0.00 0 0 0 0 0 0 1\n0.02 0 0 1 0 0 0 1\n")
        (results / "tracks.txt").write_text("0 0.00 1 1\n0 0.02 2 2\n")
        drive = argparse.Namespace(seed=1)
        self.assertEqual(row_of(drive, "em", results)["lost"], 1)
        (results / "summary.csv").write_text("alignment,mean_planar_percent\norigin-scale,0.1\n")
        self.assertEqual(row_of(drive, "em", results)["lost"], 0)

    def test_of_held_back_seeds_no_drive_is_shown(self) -> None:
        self.assertEqual(self.bench(*WORLDS, "--seeds", "1001,1002", "--methods", "em"), 0, self.err)
        self.assertIn("2 random drives", self.out)
        self.assertNotIn("The worst drives", self.out)

    def test_wrong_words(self) -> None:
        for words in (("--seeds", "3-1"), ("--seeds", "a"), ("--methods", "orb"), ("--scene", "nowhere")):
            self.assertEqual(self.bench("worlds", *words), 2, words)


class Numbers(BenchTest):
    def test_seed_lists(self) -> None:
        self.assertEqual(seed_list("3,5,8-10,9"), ["3", "5", "8", "9", "10"])
        with self.assertRaises(argparse.ArgumentTypeError):
            seed_list("1-")

    def test_percentiles(self) -> None:
        values = [float(value) for value in range(1, 11)]
        self.assertEqual(percentile(values, 0.9), 9)
        self.assertEqual(percentile(values, 1.0), 10)
        self.assertEqual(percentile([2.0, None, 1.0], 0.9), 2)
        self.assertIsNone(percentile([None], 0.5))

    def test_the_slowest_is_the_worst(self) -> None:
        rows = [{"method": "em", "lost": 0, "run_x_real_time": speed} for speed in (4.0, 1.0, 2.0)]
        names = ("mean_planar_percent", "max_planar_percent", "kitti_translation_percent", "kitti_rotation_deg_per_m",
                 "final_vertical_percent", "metric_scale_error_percent", "nees_pose", "resting_share")
        table = distribution([{**dict.fromkeys(names), **row} for row in rows])
        self.assertEqual((table[-1]["em_median"], table[-1]["em_worst"]), (2.0, 1.0))

    def test_resting_share(self) -> None:
        lines = [f"1 {0.02 * i} 10 10" for i in range(20)]  # rests
        lines += [f"2 {0.02 * i} {10 + i} 10" for i in range(20)]
        lines += [f"3 {0.02 * i} 10 10" for i in range(10)]  # too short to say
        path = self.write("tracks.txt", "# id\n" + "\n".join(lines) + "\n")
        self.assertEqual(resting_share(path), 0.4)


if __name__ == "__main__":
    unittest.main()
