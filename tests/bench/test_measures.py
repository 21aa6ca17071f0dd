"""Reading, medians, tables, targets and the words of the command line."""
from __future__ import annotations

import io
import unittest

from support import BenchTest

from bench import measures, runner, tables, targets
from bench.errors import BenchError
from bench.recordings import parse_recording
from bench.scenes import Part, parse_part, parse_scene, read_parameters
from bench.tracking_table import applies


class MediansAndTables(unittest.TestCase):
    def test_median_and_worst(self) -> None:
        self.assertEqual(tables.median([3, 1, None, 2]), 2)
        self.assertEqual(tables.median([4, 1, 3, 2]), 2.5)
        self.assertIsNone(tables.median([None]))
        self.assertEqual(tables.worst([3, None, 1], more_is_better=True), 1)
        self.assertEqual(tables.worst([3, None, 1], more_is_better=False), 3)
        self.assertIsNone(tables.worst([], True))

    def test_markdown(self) -> None:
        columns = [tables.Column("name", "name"), tables.Column("share, %", "share", ".1f", 100),
                   tables.Column("n", "n", "d")]
        text = tables.markdown(columns, [{"name": "a|b", "share": 0.125, "n": 3.0}, {"name": "c"}])
        self.assertEqual(text, "| name | share, % | n |\n|------|----------|---|\n"
                               "| a\\|b | 12.5     | 3 |\n| c    | -        | - |\n")

    def test_spread(self) -> None:
        column = tables.SpreadColumn("error", "error", ".2f")
        self.assertEqual(column.cell({"error_median": 0.5, "error_worst": 1.0, "seeds": 3}), "0.50 (1.00)")
        self.assertEqual(column.cell({"error_median": 0.5, "error_worst": 0.5, "seeds": 1}), "0.50")
        self.assertEqual(column.cell({"error_median": None, "seeds": 3}), "-")


class Targets(unittest.TestCase):
    def test_verdict(self) -> None:
        self.assertEqual(targets.verdict(0.35, "<=", 0.35), "met")
        self.assertEqual(targets.verdict(0.35, "<", 0.35), "missed")
        self.assertEqual(targets.verdict(8.0, ">=", 8), "met")
        self.assertEqual(targets.verdict(7.9, ">=", 8), "missed")
        self.assertEqual(targets.verdict(33, ">", 33), "missed")
        self.assertEqual(targets.verdict(None, ">", 33), "not measured")

    def test_number_of_features(self) -> None:
        target = targets.Target("driving_day", "real_time_factor_median", ">=", 8, features=100)
        self.assertTrue(applies(target, {"features": 100, "mean_live_features": 82.0}))
        self.assertTrue(applies(target, {"features": 122, "mean_live_features": 101.0}))
        self.assertFalse(applies(target, {"features": 20, "mean_live_features": 17.0}))

    def test_enough_of_each(self) -> None:
        self.assertEqual(len(targets.TRACKING_TARGETS), 20)
        self.assertEqual(len(targets.ODOMETRY_TARGETS), 36)
        self.assertEqual(len(targets.ABLATIONS), 25)


class Words(BenchTest):
    def test_parts(self) -> None:
        self.assertEqual(parse_part("20+8"), Part("20", "8"))
        self.assertEqual(str(parse_part("60")), "60")
        self.assertEqual(parse_part("20+8").end_s, 28)
        for text in ("", "x", "20+", "+8", "1-2"):
            with self.assertRaises(BenchError):
                parse_part(text)

    def test_scenes(self) -> None:
        self.assertEqual(parse_scene("driving_day:20+8").name, "driving_day")
        self.write_scene("swift")
        self.assertIsNone(parse_scene("swift.yaml").part)
        with self.assertRaisesRegex(BenchError, "there is no scene nowhere; there are bumps driving_day"):
            parse_scene("nowhere")

    def test_recordings(self) -> None:
        (self.folder / "street").mkdir()
        recording = parse_recording("street:0.2+1")
        self.assertEqual((recording.label, recording.name), ("street:0.2+1", "street_0.2+1"))
        self.assertEqual(recording.interval, ["--from", "0.2", "--to", "1.2"])
        self.assertEqual(parse_recording("street").interval, [])
        with self.assertRaisesRegex(BenchError, "there is no folder alley"):
            parse_recording("alley")

    def test_parameters(self) -> None:
        yaml = "motion:\n  kind: vehicle  # of it; or not\n  file: \"\"  # path\n\n  vehicle:\n    bumps_at_s: every 5  # x\n"
        self.assertEqual(read_parameters(yaml + "scene:\n  seed: 3\n"),
                         {"motion.kind": "vehicle", "motion.file": '""', "motion.vehicle.bumps_at_s": "every 5",
                          "scene.seed": "3"})


class Reading(BenchTest):
    def test_manifest(self) -> None:
        made = measures.Manifest(self.write("manifest.json", '{"counts": {"events": 7}, "rebootstraps": ["1", "2"], '
                                            '"wall_time_s": {"track": 0.5}, "cpu_time_s": 2e-1, '
                                            '"parameters": {"output": {"start_s": 9}}}'))
        self.assertEqual((made.count("events"), made.stage_s("track"), made.value("cpu_time_s")), (7, 0.5, 0.2))
        self.assertEqual((made.rebootstraps(), made.parameter("output.start_s")), (2, 9))
        self.assertIsNone(made.parameter("output.start_s.more"))
        missing = measures.Manifest(self.folder / "nothing.json")
        self.assertFalse(missing.exists)
        self.assertIsNone(missing.count("events") or missing.rebootstraps())

    def test_quantities(self) -> None:
        quality = measures.Quantities(self.write("track_quality.csv", (
            "quantity,unit,threshold_px,age_low_s,age_high_s,value\ntruth,name,,,,depth\n"
            "track_error_median,px,5.000000000,,,0.3\ntrack_error_median,px,,,,0.4\nempty,px,,,,\n")))
        self.assertEqual(quality.text("truth", "name"), "depth")
        self.assertEqual(quality.number("track_error_median", "px", 5), 0.3)
        self.assertEqual(quality.number("track_error_median", "px"), 0.4)
        self.assertIsNone(quality.number("track_error_median", "px", 3))
        self.assertIsNone(quality.number("empty", "px"))

    def test_summary_and_metrics(self) -> None:
        summary = measures.Summary(self.write("summary.csv", "alignment,mean\norigin-scale,0.1\nsim3,\n"))
        self.assertEqual(summary.number("origin-scale", "mean"), 0.1)
        self.assertIsNone(summary.number("sim3", "mean"))
        self.assertIsNone(summary.number("se3", "mean"))
        metrics = self.write("metrics.csv", (
            "sequence,alignment,metric,quantity,unit,delta,mean\ns,none,rpe,translation,m,5,0.01\n"
            "s,origin-scale,subtrajectory,rotation,deg/m,5,0.3\ns,origin-scale,subtrajectory,rotation,deg/m,9,0.2\n"))
        self.assertAlmostEqual(measures.error_over_5_m_percent(metrics, "none"), 0.2)
        self.assertIsNone(measures.error_over_5_m_percent(metrics, "sim3"))
        self.assertEqual(measures.rotation_drift_deg_per_m(metrics), 0.2)

    def test_coverage(self) -> None:
        trajectory = self.write("trajectory.txt", "# stamp\n" + "".join(f"{t} 0 0 0 0 0 0 1\n" for t in (1, 1.5, 2.5)))
        tracks = self.write("tracks.txt", "1 0.5 3 4\n1 5.0 3 4\n")
        self.assertAlmostEqual(measures.coverage_since_start(trajectory, tracks), 1 - (1.0 + 2.5) / 4)
        self.assertEqual(measures.track_duration_s(tracks), 4.5)
        self.assertEqual(measures.last_track_stamp(tracks), "5.0")
        self.assertIsNone(measures.coverage_since_start(self.folder / "none.txt", tracks))

    def test_failures(self) -> None:
        self.assertEqual(measures.failure_of(self.folder), "")
        self.write("judging.txt", "one\nno depth\n")
        self.assertEqual(measures.failure_of(self.folder), "not judged: no depth")
        self.write("failure.txt", "exit code 6: lost\n")
        self.assertEqual(measures.failure_of(self.folder), "exit code 6: lost")


class ProgressOnATerminal(unittest.TestCase):
    def test_time_left(self) -> None:
        class Terminal(io.StringIO):
            def isatty(self) -> bool:
                return True

        stream, now = Terminal(), [0.0]
        jobs = [runner.Job("run one", lambda: None, 1), runner.Job("run two", lambda: None, 9)]
        progress = runner.Progress(jobs, stream, lambda: now[0])
        progress.start(jobs[0])
        now[0] = 60.0
        progress.finish(jobs[0])
        progress.start(jobs[1])
        self.assertEqual(stream.getvalue(), "[1/2] run one\n[2/2, about 9 min left] run two\n")


if __name__ == "__main__":
    unittest.main()
