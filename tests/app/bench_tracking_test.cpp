// scripts/bench_tracking.sh, on a slider that is fast and short.
#include "app/bench_script.hpp"

namespace evo::app {
namespace {

namespace fs = std::filesystem;

class BenchTrackingTest : public BenchScriptTest {
 protected:
  BenchTrackingTest() : BenchScriptTest("bench_tracking") {}

  void SetUp() override {
    BenchScriptTest::SetUp();
    WriteScene("swift");
  }
};

TEST_F(BenchTrackingTest, RowsMediansAndTargets) {
  // A scene of that name has targets.
  fs::rename(folder / "swift.yaml", folder / "driving_day.yaml");
  ASSERT_EQ(Bench("--seeds 1,2 --features 20 --repeats 1 driving_day.yaml"), 0) << err;
  const auto rows = Table("tracking.csv");
  ASSERT_EQ(rows.size(), 4u);
  for (const auto& row : rows) {
    EXPECT_EQ(row.at("scene"), "driving_day:0.3");
    EXPECT_EQ(row.at("truth"), "depth");
    for (const std::string name :
         {"recorded_s", "events_per_s", "mean_live_features", "real_time_factor_median", "cpu_s_per_recorded_s",
          "peak_memory_mb", "tracks_judged", "track_error_median_px", "track_error_to_5_px_median_px",
          "expected_age_at_5_px_share", "expected_age_at_5_px_s", "lifetime_frames", "lifetime_s"}) {
      EXPECT_GT(std::stod(row.at(name)), 0.0) << name;
    }
    for (const std::string name :
         {"tracks_over_3_px_share", "tracks_mostly_over_3_px_share", "tracks_astray_over_3_px_share",
          "positions_past_3_px_share", "tracks_that_move_share"}) {
      EXPECT_GE(std::stod(row.at(name)), 0.0) << name;
      EXPECT_LT(std::stod(row.at(name)), 1.0) << name;
    }
    EXPECT_EQ(row.at("frame_interval_s"), "0.020000000");
    EXPECT_EQ(row.at("triangulation_residual_median_px"), "");
    EXPECT_EQ(row.at("failure"), "");
  }
  EXPECT_EQ(rows[0].at("seed") + rows[1].at("seed") + rows[2].at("seed") + rows[3].at("seed"), "1122");
  EXPECT_EQ(rows[0].at("method") + rows[1].at("method"), "emklt");

  const auto medians = Table("tracking_medians.csv");
  ASSERT_EQ(medians.size(), 2u);
  EXPECT_EQ(medians[0].at("seeds"), "2");
  EXPECT_EQ(medians[0].at("method"), "em");
  for (const std::string name : {"lifetime_frames", "track_error_median_px", "cpu_s_per_recorded_s"}) {
    EXPECT_NEAR(std::stod(medians[0].at(name)), (std::stod(rows[0].at(name)) + std::stod(rows[2].at(name))) / 2, 1e-6);
  }

  EXPECT_NE(out.find("\nMedians over the seeds\n"), std::string::npos) << out;
  EXPECT_NE(out.find("\nTargets of em"), std::string::npos) << out;
  EXPECT_NE(out.find("lifetime_frames                  >    33"), std::string::npos) << out;
  EXPECT_NE(out.find("age_share_over_klts             >=   1.5"), std::string::npos) << out;
  EXPECT_EQ(out.find("real_time_factor_median"), std::string::npos) << "has targets for 100 and 300 features only";
  EXPECT_EQ(ReadFile(folder / "out/bench_tracking/tracking.txt"), out);
}

TEST_F(BenchTrackingTest, OnlyWhatHasChangedIsDoneAgain) {
  const std::string words = "--seeds 1 --methods em --features 20 --repeats 2 swift.yaml";
  ASSERT_EQ(Bench(words), 0) << err;
  EXPECT_TRUE(Simulated());
  EXPECT_EQ(CountRuns(), 2) << err;
  ExpectNothingToDo(words);
  const std::string before = out;

  ASSERT_EQ(Bench(words + " --draw-every 0.1"), 0) << err;
  EXPECT_EQ(CountRuns(), 0) << err;
  EXPECT_GT(CountFiles(folder / "out/bench_tracking/swift_1_0.3/em_20/drawn/images"), 0);
  EXPECT_EQ(out, before);

  ASSERT_EQ(Bench(words + " --features 20,30"), 0) << err;
  EXPECT_EQ(CountRuns(), 2) << "only those with 30";
  ASSERT_EQ(Bench(words + " --set tracker.patch_radius_px=9"), 0) << err;
  EXPECT_FALSE(Simulated());
  EXPECT_EQ(CountRuns(), 2) << err;
}

TEST_F(BenchTrackingTest, RecordingsWithAndWithoutGroundTruth) {
  fs::create_directories(folder / "blind");
  fs::copy_file(Sample("street_data.hdf5"), folder / "blind/street_data.hdf5");
  fs::copy_file(Sample("camchain-imucam-street.yaml"), folder / "blind/camchain-imucam-street.yaml");
  ASSERT_EQ(Run("simulate '" + Path("swift.yaml") + "' --format uzh --set simulation.depth_hz=0 --quiet --out '" +
                Path("flat") + "'"),
            0)
      << err;
  fs::remove(folder / "flat/depth_gt.hdf5");
  ASSERT_EQ(Bench("--recording blind:0.2+0.3 --recording flat --methods em --features 20 --repeats 1"), 0) << err;
  EXPECT_FALSE(Simulated()) << "no scenes beside";
  const auto rows = Table("tracking.csv");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].at("scene"), "blind:0.2+0.3");
  EXPECT_NEAR(std::stod(rows[0].at("recorded_s")), 0.3, 0.05);
  EXPECT_EQ(rows[0].at("truth") + rows[0].at("tracks_judged") + rows[0].at("failure"), "");
  EXPECT_GT(std::stod(rows[0].at("lifetime_frames")), 0.0);
  EXPECT_EQ(rows[1].at("scene"), "flat");
  EXPECT_EQ(rows[1].at("truth"), "triangulated");
  EXPECT_GT(std::stod(rows[1].at("triangulation_residual_median_px")), 0.0);
  EXPECT_EQ(rows[1].at("track_error_median_px"), "");
}

TEST_F(BenchTrackingTest, ScalingHasThreeTablesAndPlots) {
  ASSERT_EQ(Bench("--scaling --methods em --features 20 --repeats 1 swift.yaml"), 0) << err;
  const auto events = Table("scaling_events.csv");
  ASSERT_EQ(events.size(), 3u);
  EXPECT_GT(std::stod(events[1].at("events_per_s")), 1.4 * std::stod(events[0].at("events_per_s")));
  EXPECT_GT(std::stod(events[2].at("events_per_s")), 1.4 * std::stod(events[1].at("events_per_s")));
  const auto by_features = Table("scaling_features.csv");
  ASSERT_EQ(by_features.size(), 6u);
  EXPECT_EQ(by_features[5].at("features"), "600");
  const auto length = Table("scaling_length.csv");
  ASSERT_EQ(length.size(), 3u);
  EXPECT_LT(std::stod(length[0].at("recorded_s")), std::stod(length[2].at("recorded_s")));
  for (const auto& row : length) EXPECT_GT(std::stod(row.at("peak_memory_mb")), 0.0);
  for (const std::string name : {"events", "features", "length"}) {
    const std::string script = ReadFile(folder / "out/bench_tracking" / ("scaling_" + name + ".gnuplot"));
    EXPECT_NE(script.find("plot "), std::string::npos) << name;
  }
  if (std::system("gnuplot --version >/dev/null 2>&1") == 0) {
    EXPECT_NE(ReadFile(folder / "out/bench_tracking/scaling_events.svg").find("</svg>"), std::string::npos);
  }
}

TEST_F(BenchTrackingTest, ARunThatFailsHasARow) {
  fs::create_directories(folder / "broken");
  Write("broken/events.txt", "no events\n");
  EXPECT_EQ(Bench("--recording broken --methods em --features 20 --repeats 1"), 1) << out;
  const auto rows = Table("tracking.csv");
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_TRUE(rows[0].at("failure").starts_with("exit code ")) << rows[0].at("failure");
  EXPECT_EQ(rows[0].at("real_time_factor_median"), "");
}

TEST_F(BenchTrackingTest, WrongWordsAreRefusedBeforeAnythingIsDone) {
  for (const std::string words :
       {"--speed 3", "--methods em,lk swift.yaml", "--features 0", "--seeds 1,", "--repeats 0", "--threads x", "--set",
        "--set tracker.features=9", "swift.yaml nowhere", "--recording nowhere", "--long", "--scaling --recording ."}) {
    EXPECT_EQ(Bench(words), 2) << words;
    EXPECT_TRUE(err.starts_with("bench_tracking: error: ")) << words << ": " << err;
    EXPECT_EQ(std::ranges::count(err, '\n'), 1) << err;
  }
  EXPECT_FALSE(fs::exists(folder / "out"));
  EXPECT_EQ(Bench("--help"), 0);
  EXPECT_NE(out.find("--draw-every S"), std::string::npos);
}

}  // namespace
}  // namespace evo::app
