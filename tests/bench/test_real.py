"""The benchmarks with the real program that EVO_RUN names."""
from __future__ import annotations

import os
import shutil
import unittest

from support import ROOT, BenchTest

REAL = os.environ.get("EVO_RUN", "")


@unittest.skipUnless(REAL, "EVO_RUN names no program")
class RealProgram(BenchTest):
    def setUp(self) -> None:
        super().setUp()
        os.environ["EVO_RUN"] = REAL
        self.write_scene("slider")

    def test_tracking_odometry_and_docs(self) -> None:
        words = ("--seeds", "1", "slider.yaml")
        self.assertEqual(self.bench("tracking", "--features", "20", "--repeats", "1", *words), 0, self.err)
        for row in self.table("out/bench_tracking/tracking.csv"):
            self.assertEqual((row["truth"], row["failure"]), ("depth", ""))
            for name in ("recorded_s", "events_per_s", "mean_live_features", "real_time_factor_median",
                         "cpu_s_per_recorded_s", "peak_memory_mb", "tracks_judged", "track_error_median_px",
                         "track_error_to_5_px_median_px", "expected_age_at_5_px_share", "expected_age_at_5_px_s",
                         "lifetime_frames", "lifetime_s"):
                self.assertGreater(float(row[name]), 0, name)
            for name in ("tracks_over_3_px_share", "tracks_mostly_over_3_px_share", "tracks_astray_over_3_px_share",
                         "positions_past_3_px_share", "tracks_that_move_share"):
                self.assertTrue(0 <= float(row[name]) < 1, name)
        self.assertEqual(self.bench("odometry", *words, "--recording", f"{ROOT}/data_samples/street:0.2+1.2"), 0, self.err)
        rows = self.table("out/bench_odometry/odometry.csv")
        self.assertEqual([row["scene"] for row in rows], ["slider:0.3"] * 3 + ["street:0.2+1.2"] * 3)
        for name in ("recorded_s", "path_m", "coverage_share", "mean_planar_percent", "max_planar_percent",
                     "rotation_deg_per_m", "run_x_real_time", "odometry_x_real_time", "cpu_s"):
            self.assertGreater(float(rows[0][name]), 0, name)
        self.assertEqual(rows[0]["sim3_mean_planar_percent"], "", "a straight line")
        self.assertAlmostEqual(float(rows[3]["recorded_s"]), 1.2, delta=0.05)
        self.assertEqual(self.bench("docs", "--to", "benchmarks.md"), 0, self.err)

    def test_given_tracks_are_followed_as_our_own(self) -> None:
        from bench.program import find_program
        street = ROOT / "data_samples" / "street"
        find_program().output("track", "--events", str(street), "--no-plots", "--quiet", "--out", "tracked")
        (self.folder / "given").mkdir()
        for file in (self.folder / "tracked/tracks.txt", street / "street_gt.hdf5",
                     street / "camchain-imucam-street.yaml"):
            shutil.copy(file, self.folder / "given")
        self.assertEqual(self.bench("odometry", "--config", "ours", "--recording", "given", "--recording", str(street)),
                         0, self.err)
        given, ours = self.table("out/bench_odometry/odometry.csv")
        for name in ("mean_planar_percent", "coverage_since_start_share"):
            self.assertEqual(given[name], ours[name])
        self.assertEqual(given["run_x_real_time"], "", "nothing was tracked")
        self.assertGreater(float(given["odometry_x_real_time"]), 0)
        self.assertGreater(float(given["sim3_ape_rmse_percent"]), 0)

    def test_without_depth_tracks_are_triangulated(self) -> None:
        from bench.program import find_program
        find_program().output("simulate", "slider.yaml", "--format", "uzh", "--set", "simulation.depth_hz=0", "--quiet",
                              "--out", "flat")
        (self.folder / "flat/depth_gt.hdf5").unlink(missing_ok=True)
        self.assertEqual(self.bench("tracking", "--recording", "flat", "--methods", "em", "--features", "20",
                                    "--repeats", "1"), 0, self.err)
        row = self.table("out/bench_tracking/tracking.csv")[0]
        self.assertEqual((row["truth"], row["track_error_median_px"]), ("triangulated", ""))
        self.assertGreater(float(row["triangulation_residual_median_px"]), 0)

    def test_lower_thresholds_make_more_events(self) -> None:
        self.assertEqual(self.bench("scaling", "--methods", "em", "--features", "20", "--repeats", "1", "slider.yaml"),
                         0, self.err)
        rates = [float(row["events_per_s"]) for row in self.table("out/bench_tracking/scaling_events.csv")]
        self.assertGreater(rates[1], 1.4 * rates[0])
        self.assertGreater(rates[2], 1.4 * rates[1])
        lengths = [float(row["recorded_s"]) for row in self.table("out/bench_tracking/scaling_length.csv")]
        self.assertLess(lengths[0], lengths[2])

    def test_the_papers_configuration_follows_the_street(self) -> None:
        from bench import targets
        from bench.measures import Manifest
        from bench.program import find_program
        program, paper = find_program(), str(ROOT / "configs/paper.yaml")
        program.output("config", "--check", paper)
        printed = program.output("run", "--config", paper, "--no-plots", "--quiet", "--events",
                                 str(ROOT / "data_samples/street"), "--out", "paper")
        self.assertIn("coverage 100.0 %", printed)
        manifest = Manifest(self.folder / "paper/manifest.json")
        for name in ("tracker.ego_motion", "tracker.rotation_correction", "tracker.rotation_spline",
                     "odometry.window_refinement", "odometry.final_refinement", "odometry.bootstrap.refine"):
            self.assertIs(manifest.parameter(name), False, name)

    def test_parameters_of_the_benchmarks_exist(self) -> None:
        from bench import compare_commands, targets
        from bench.configurations import configurations
        from bench.program import find_program
        program = find_program()
        configurations([], [*targets.ABLATIONS, targets.MORE_FEATURES, targets.BASELINE], program)
        configurations(["ours", "paper"], list(compare_commands.VARIANTS.values())[2:], program)
        words = [word for value in targets.SLOW_DRIVE for word in ("--set", value)]
        program.output("simulate", "--print", *words, "--set", f"{targets.BUMPS_AT}=")

    def test_a_run_that_fails_has_a_row(self) -> None:
        self.write_scene("slider", length_m="0.01")
        self.assertEqual(self.bench("odometry", "--seeds", "1", "--config", "ours", "slider.yaml"), 1)
        row = self.table("out/bench_odometry/odometry.csv")[0]
        self.assertTrue(row["failure"].startswith("exit code 6: "), row["failure"])
        self.assertEqual(row["mean_planar_percent"], "")


if __name__ == "__main__":
    unittest.main()
