"""The benchmarks with a fake evo-run: rows, medians, resumption, failures, wrong words, docs/benchmarks.md."""
from __future__ import annotations

import json
import unittest
from pathlib import Path

from support import BenchTest

from bench import targets
from bench.bumps import bump_stamp, scaled
from bench.scenes import Part, Scene, Sequence

TRACKING = ("tracking", "--features", "20", "--repeats", "2", "driving_day.yaml")


class Tracking(BenchTest):
    def setUp(self) -> None:
        super().setUp()
        self.write_scene("driving_day")

    def test_rows_medians_and_targets(self) -> None:
        self.assertEqual(self.bench(*TRACKING, "--seeds", "1,2"), 0, self.err)
        rows = self.table("out/bench_tracking/tracking.csv")
        self.assertEqual([row["seed"] + row["method"] for row in rows], ["1em", "1klt", "2em", "2klt"])
        self.assertEqual(rows[0]["scene"], "driving_day:0.3")
        self.assertEqual([float(rows[0][name]) for name in ("real_time_factor_median", "mean_live_features",
                          "positions_past_3_px_share", "tracks_that_move_share", "lifetime_frames")],
                         [10, 20, 0.1, 0.1, 40])
        self.assertEqual((rows[0]["truth"], rows[0]["triangulation_residual_median_px"], rows[0]["failure"]),
                         ("depth", "", ""))
        medians = self.table("out/bench_tracking/tracking_medians.csv")
        self.assertEqual([(row["method"], row["seeds"], row["lifetime_frames"]) for row in medians],
                         [("em", "2", "45"), ("klt", "2", "45")])
        self.assertIn("Medians over the seeds", self.out)
        self.assertIn("Targets", self.out)
        self.assertRegex(self.out, r"lifetime_frames +\| median +\| > 33 +\| - +\| 45 +\| met")
        self.assertRegex(self.out, r"tracks_over_3_px_percent +\| median +\| < 2 +\| - +\| 12.5 +\| missed")
        self.assertNotIn("real_time_factor_median", self.out, "has targets for 100 and 300 features only")
        self.assertEqual((self.folder / "out/bench_tracking/tracking.md").read_text(), self.out)

    def test_only_what_has_changed_is_done_again(self) -> None:
        words = (*TRACKING, "--seeds", "1", "--methods", "em")
        self.assertEqual(self.bench(*words), 0, self.err)
        self.assertEqual((self.done("simulate"), self.done("run"), self.done("judge")), (1, 1, 1))
        before = self.out
        self.assertEqual(self.bench(*words), 0)
        self.assertEqual((self.out, self.err), (before, ""), "nothing to do, and the same said")
        self.bench(*words, "--draw-every", "0.1")
        self.assertEqual((self.done("run"), self.done("draw")), (0, 1))
        self.bench(*words, "--set", "tracker.patch_radius_px=9")
        self.assertEqual((self.done("simulate"), self.done("run")), (0, 1))
        self.bench(*words, "--features", "20,30", "--set", "tracker.patch_radius_px=9")
        self.assertEqual(self.done("run"), 1, "only those with 30")
        self.write_fake("fake/evo-run", build="two")
        self.bench(*words)
        self.assertEqual((self.done("simulate"), self.done("run")), (0, 1), "another build")

    def test_interrupted_results_are_made_again(self) -> None:
        words = (*TRACKING, "--seeds", "1", "--methods", "em")
        self.bench(*words)
        results = self.folder / "out/bench_tracking/driving_day_1_0.3/em_20"
        (results / "made_from.txt").unlink()
        self.bench(*words)
        self.assertEqual(self.done("run"), 1)
        (self.folder / "out/scenes/driving_day_1_0.3/made_from.txt").write_text("")
        self.bench(*words)
        self.assertEqual(self.done("simulate"), 1)

    def test_recordings(self) -> None:
        self.write("blind/events.txt", "0 1 1 1\n")
        self.assertEqual(self.bench("tracking", "--recording", "blind:0.2+0.3", "--methods", "em", "--features", "20"), 0)
        self.assertEqual(self.done("simulate"), 0, "no scenes beside")
        row = self.table("out/bench_tracking/tracking.csv")[0]
        self.assertEqual(row["scene"] + row["truth"] + row["failure"], "blind:0.2+0.3")
        self.assertIn("--from 0.2 --to 0.5", (self.folder / "fake/calls.txt").read_text())

    def test_a_run_that_fails_has_a_row(self) -> None:
        self.set_environment("FAKE_EXIT", "6")
        self.assertEqual(self.bench(*TRACKING, "--seeds", "1"), 1)
        row = self.table("out/bench_tracking/tracking.csv")[0]
        self.assertEqual(row["failure"], "exit code 6: tracking is lost, it seems")
        self.assertEqual(row["real_time_factor_median"], "")
        self.assertIn("failed     ", self.err)

    def test_scaling(self) -> None:
        self.assertEqual(self.bench("scaling", "--methods", "em", "--features", "20", "--long", "driving_day.yaml"), 0,
                         self.err)
        self.assertEqual(len(self.table("out/bench_tracking/scaling_events.csv")), 3)
        features = self.table("out/bench_tracking/scaling_features.csv")
        self.assertEqual([row["features"] for row in features], ["50", "100", "200", "300", "450", "600"])
        self.assertEqual(len(self.table("out/bench_tracking/scaling_length.csv")), 3 + 4)
        self.assertIn("--set sensor.threshold_on=0.3 --set sensor.threshold_off=0.12",
                      (self.folder / "fake/calls.txt").read_text())
        for name in ("events", "features", "length"):
            self.assertIn("plot ", (self.folder / f"out/bench_tracking/scaling_{name}.gnuplot").read_text())
        self.bench("scaling", "--methods", "em", "--features", "20", "--long", "driving_day.yaml")
        self.assertEqual(self.err, "", "the slow drive is deleted, its results are not made again")


class Scenes(BenchTest):
    def setUp(self) -> None:
        super().setUp()
        self.write_scene("swift")

    def test_only_what_has_changed_is_done_again(self) -> None:
        self.assertEqual(self.bench("scenes", "swift.yaml"), 0, self.err)
        row = self.table("out/bench_scenes/scenes.csv")[0]
        self.assertEqual((row["scene"], row["seed"], row["simulated_s"], row["negative_per_positive"], row["failure"]),
                         ("swift", "1", "0.3", "1.5", ""))
        self.assertEqual(len(row), 22)
        self.bench("scenes", "swift.yaml", "--delete")
        self.assertEqual(self.err, "")
        kept = sorted(path.name for path in (self.folder / "out/scenes/swift_1_0.3").iterdir())
        self.assertEqual(kept, ["made_from.txt", "manifest.json", "simulated_by.json"])
        self.bench("scenes", "swift.yaml")
        self.assertEqual(self.err, "")
        self.bench("scenes", "swift.yaml", "--set", "tracker.features=100")
        self.assertEqual((self.done("simulate"), self.done("run")), (1, 1), "the sequence was deleted")
        self.bench("scenes", "swift.yaml", "--simulate-only", "--seeds", "1,2")
        self.assertEqual(self.out, "out/scenes/swift_1_0.3\nout/scenes/swift_2_0.3\n")

    def test_other_folders_are_left_alone(self) -> None:
        mine = self.write("out/scenes/swift_1_0.3/events.txt", "mine")
        self.assertEqual(self.bench("scenes", "swift.yaml"), 2)
        self.assertIn("was not made by a benchmark", self.err)
        self.assertEqual(mine.read_text(), "mine")
        self.write("out/scenes/swift_1_0.3/made_from.txt", "")
        self.assertEqual(self.bench("scenes", "swift.yaml", "--simulate-only"), 0, "one that was interrupted")
        self.write("out/bench_scenes/swift_1_0.3/notes.txt", "mine")
        self.assertEqual(self.bench("scenes", "swift.yaml"), 2)
        self.assertIn("is left alone", self.err)

    def test_a_run_that_fails_has_a_row(self) -> None:
        self.set_environment("FAKE_EXIT", "6")
        self.assertEqual(self.bench("scenes", "swift.yaml"), 1)
        self.assertIn("exit code 6: ", self.out)


class Odometry(BenchTest):
    def test_summary_targets_and_plots(self) -> None:
        self.write_scene("slider")
        self.assertEqual(self.bench("odometry", "--seeds", "1,2", "slider.yaml"), 0, self.err)
        rows = self.table("out/bench_odometry/odometry.csv")
        self.assertEqual([row["config"] for row in rows[:3]], ["ours", "paper", "tracker.features=300"])
        self.assertAlmostEqual(float(rows[0]["coverage_since_start_share"]), 0.4)
        summary = self.table("out/bench_odometry/odometry_summary.csv")
        self.assertEqual(len(summary), 3)
        self.assertEqual([summary[0][name] for name in ("seeds", "failures", "mean_planar_percent_median",
                          "mean_planar_percent_worst", "run_x_real_time_worst")], ["2", "0", "0.15", "0.2", "4"])
        self.assertIn("slider:0.3, 2 seeds: median (worst)", self.out)
        self.assertRegex(self.out, r"rebootstraps +\| worst +\| <= 0 +\| - +\| 0 +\| met")
        self.assertRegex(self.out, r"coverage_since_start_share +\| worst +\| >= 0.98 +\| - +\| 0.4 +\| missed")
        self.assertEqual((self.folder / "out/bench_odometry/odometry.md").read_text(), self.out)
        self.assertIn("plot ", (self.folder / "out/bench_odometry/odometry_error.gnuplot").read_text())

    def test_only_what_has_changed_is_done_again(self) -> None:
        self.write_scene("swift")
        self.write("mine.yaml", "odometry:\n  final_refinement: false\n")
        words = ("odometry", "--seeds", "1", "--config", "ours", "--config", "mine.yaml", "swift.yaml")
        self.bench(*words)
        self.assertEqual(self.done("run"), 2)
        self.bench(*words)
        self.assertEqual(self.err, "")
        self.write("mine.yaml", "odometry:\n  window_refinement: false\n")
        self.bench(*words)
        self.assertEqual(self.done("run"), 1, "only that of the file")
        self.bench("odometry", "--seeds", "1", "--set", "odometry.window=6 odometry.lag=3", "swift.yaml")
        self.assertEqual(self.done("run"), 1, "only the variant")
        self.assertEqual(self.table("out/bench_odometry/odometry.csv")[1]["config"], "odometry.window=6 odometry.lag=3")

    def test_bumps_are_compared_with_the_road_without_them(self) -> None:
        self.write_scene("bumps")
        self.assertEqual(self.bench("odometry", "--seeds", "1", "--config", "ours", "bumps.yaml"), 0, self.err)
        self.assertEqual([row["scene"] for row in self.table("out/bench_odometry/odometry.csv")],
                         ["bumps:0.3", "bumps_level:0.3"])
        self.assertRegex(self.out, r"error_over_that_of_level +\| median +\| <= 1.5 +\| - +\| 1 +\| met")
        self.bench("ablation", "--seeds", "1", "bumps.yaml")
        self.assertEqual(len(self.table("out/bench_odometry/ablation.csv")), 26, "ours and 25 ingredients")
        self.assertNotIn("Targets", self.out)

    def test_given_tracks(self) -> None:
        self.write("given/tracks.txt", "1 0.0 5 5\n1 2.0 6 5\n")
        self.write("given/groundtruth.txt", "0 0 0 0 0 0 0 1\n")
        self.write("given/calib.txt", "1 1 1 1\n")
        self.assertEqual(self.bench("odometry", "--config", "ours", "--recording", "given"), 0, self.err)
        row = self.table("out/bench_odometry/odometry.csv")[0]
        self.assertEqual(row["mean_planar_percent"], "0")
        self.assertIn("odometry --tracks given/tracks.txt --calibration given/calib.txt",
                      (self.folder / "fake/calls.txt").read_text())
        self.assertEqual(self.bench("odometry", "--recording", "given:1"), 2)

    def test_a_run_that_fails_has_a_row(self) -> None:
        self.write_scene("slider")
        self.set_environment("FAKE_EXIT", "6")
        self.assertEqual(self.bench("odometry", "--seeds", "1", "--config", "ours", "slider.yaml"), 1)
        self.assertTrue(self.table("out/bench_odometry/odometry.csv")[0]["failure"].startswith("exit code 6: "))
        self.assertIn("missed: 1 of 1 failed", self.out)


class Bumps(BenchTest):
    def test_stamp_of_the_first_bump(self) -> None:
        scene = Scene(Path("driving_day.yaml"), None)
        self.write("sequence/manifest.json", '{"parameters": {"output": {"start_s": 100}}}')

        def stamp(part: Part, bumps: str) -> float | None:
            sequence = Sequence(scene, "1", part, self.folder / "sequence", "", ())
            return bump_stamp(sequence, {targets.BUMPS_AT: bumps})

        self.assertEqual(stamp(Part("", "60"), "52,56"), 152)
        self.assertEqual(stamp(Part("45", "15"), "52,56"), 107)
        self.assertIsNone(stamp(Part("50", "8"), "52,56"), "not 5 s before")
        self.assertIsNone(stamp(Part("", "60"), "every 5"))
        self.assertIsNone(stamp(Part("", "60"), '""'))

    def test_positions_are_scaled(self) -> None:
        self.assertEqual(scaled("# t x y z\n1.5 1 2 -3 0 0 0 1\n", 2.0),
                         "1.5 2.000000000 4.000000000 -6.000000000 0 0 0 1\n")


class WrongWords(BenchTest):
    def test_are_refused_before_anything_is_done(self) -> None:
        self.write_scene("swift")
        for words in ("tracking --speed 3", "tracking --methods em,lk swift.yaml", "tracking --features 0",
                      "tracking --seeds 1,", "tracking --repeats 0", "tracking --threads x", "tracking --set",
                      "tracking --set tracker.features=9", "tracking swift.yaml nowhere", "tracking --recording nowhere",
                      "scaling --recording .", "odometry --set odometry.window swift.yaml", "odometry --config nothing",
                      "odometry --config paper --config paper swift.yaml", "scenes --speed 3", "scenes nowhere",
                      "all --recording nowhere", "docs --speed 3", "compare one", "nothing"):
            self.assertEqual(self.bench(*words.split()), 2, words)
            self.assertTrue(self.err.startswith("bench " + words.split()[0] + ": error: "), self.err)
            self.assertEqual(self.err.count("\n"), 1, self.err)
        self.assertFalse((self.folder / "out").exists())

    def test_help(self) -> None:
        for name in ("tracking", "scaling", "scenes", "odometry", "ablation", "worlds", "evaluation", "all", "docs",
                     "compare"):
            with self.assertRaises(SystemExit) as end:
                self.bench(name, "--help")
            self.assertEqual(end.exception.code, 0)


class Documents(BenchTest):
    def test_holds_one_build_only(self) -> None:
        self.write_scene("driving_day")
        self.bench(*TRACKING, "--seeds", "1,2")
        page = self.folder / "docs/benchmarks.md"
        self.assertEqual(self.bench("docs", "--to", str(page)), 0, self.err)
        text = page.read_text()
        self.assertIn("SHA-256 ", text)
        self.assertIn("tracking 1, 2", text)
        self.assertIn("| em     |", text)
        self.assertIn("- *error, px*: Median over the tracks", text)
        self.assertRegex(text, r"\| missed +\|")
        self.assertIn("Not measured with this build: it has not been run", text)
        self.assertIn("0.132 % of the path", text)
        self.assertNotIn(str(self.folder), text)

        self.write_fake("fake/evo-run", build="two")
        self.assertEqual(self.bench("docs", "--check"), 1)
        self.assertEqual(self.bench("docs", "--to", str(page)), 1)
        self.assertEqual(page.read_text(), text, "nothing was measured with the new build")
        self.bench("evaluation", "--poses", "10", "--repeats", "2")
        self.assertEqual(self.bench("docs", "--to", str(page)), 0)
        text = page.read_text()
        self.assertIn("its last results are of another build", text)
        self.assertNotIn("| em     |", text)
        self.assertRegex(text, r"\| evaluate \| 0.200 +\| 0.200 ")

    def test_sequences_of_another_simulator_are_named(self) -> None:
        self.write_scene("driving_day")
        self.bench(*TRACKING, "--seeds", "1", "--methods", "em")
        self.write_fake("fake/evo-run", build="two")
        self.bench(*TRACKING, "--seeds", "1", "--methods", "em")
        record = json.loads(Path("out/bench_tracking/tracking.json").read_text())
        self.assertEqual(len(record["other_simulators"]), 1)


if __name__ == "__main__":
    unittest.main()
