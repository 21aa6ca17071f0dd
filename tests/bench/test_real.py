"""The benchmarks with the real program that EVO_RUN names."""
from __future__ import annotations

import os
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
        self.assertEqual(self.bench("odometry", *words, "--recording", f"{ROOT}/data_samples/street:0.2+1"), 0, self.err)
        rows = self.table("out/bench_odometry/odometry.csv")
        self.assertEqual([row["scene"] for row in rows], ["slider:0.3"] * 3 + ["street:0.2+1"] * 3)
        for name in ("recorded_s", "path_m", "coverage_share", "mean_planar_percent", "max_planar_percent",
                     "rotation_deg_per_m", "run_x_real_time", "odometry_x_real_time", "cpu_s"):
            self.assertGreater(float(rows[0][name]), 0, name)
        self.assertEqual(rows[0]["sim3_mean_planar_percent"], "", "a straight line")
        self.assertAlmostEqual(float(rows[3]["recorded_s"]), 1.0, delta=0.05)
        self.assertEqual(self.bench("docs", "--to", "benchmarks.md"), 0, self.err)

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
