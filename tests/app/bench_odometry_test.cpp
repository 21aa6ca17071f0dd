// scripts/bench_odometry.sh, on a slider that is fast and short, and what it measures with: configs/paper.yaml.
#include "app/bench_script.hpp"

namespace evo::app {
namespace {

namespace fs = std::filesystem;

class BenchOdometryTest : public BenchScriptTest {
 protected:
  BenchOdometryTest() : BenchScriptTest("bench_odometry") {}
};

TEST_F(BenchOdometryTest, RowsSummaryTargetsAndPlots) {
  WriteScene("slider");  // a scene of that name has targets
  ASSERT_EQ(Bench("--seeds 1,2 slider.yaml"), 0) << err;
  const auto rows = Table("odometry.csv");
  ASSERT_EQ(rows.size(), 6u);
  for (const auto& row : rows) {
    EXPECT_EQ(row.at("scene"), "slider:0.3");
    EXPECT_EQ(row.at("failure"), "");
    EXPECT_EQ(row.at("sim3_mean_planar_percent"), "") << "a straight line";
    EXPECT_EQ(row.at("bump_growth"), "");
    for (const std::string name :
         {"recorded_s", "path_m", "coverage_share", "mean_planar_percent", "max_planar_percent", "rotation_deg_per_m",
          "run_x_real_time", "odometry_x_real_time", "cpu_s"}) {
      EXPECT_GT(std::stod(row.at(name)), 0.0) << name;
    }
    EXPECT_GE(std::stod(row.at("odometry_x_real_time")), std::stod(row.at("run_x_real_time")));
  }
  for (const std::size_t ours : {0, 3}) {
    EXPECT_EQ(rows[ours].at("config"), "ours");
    EXPECT_EQ(rows[ours].at("rebootstraps") + rows[ours].at("frames_lost"), "00");
    EXPECT_EQ(std::stod(rows[ours].at("coverage_since_start_share")), 1.0);
  }
  EXPECT_EQ(rows[1].at("config"), "paper");
  EXPECT_EQ(rows[2].at("config"), "tracker.features=300");
  EXPECT_EQ(rows[0].at("seed") + rows[3].at("seed"), "12");

  const auto summary = Table("odometry_summary.csv");
  ASSERT_EQ(summary.size(), 3u);
  EXPECT_EQ(summary[0].at("seeds") + summary[0].at("failures"), "20");
  const double a = std::stod(rows[0].at("mean_planar_percent")), b = std::stod(rows[3].at("mean_planar_percent"));
  EXPECT_NEAR(std::stod(summary[0].at("mean_planar_percent_median")), (a + b) / 2, 1e-6);
  EXPECT_NEAR(std::stod(summary[0].at("mean_planar_percent_worst")), std::max(a, b), 1e-6);
  EXPECT_NE(out.find("slider:0.3, 2 seeds"), std::string::npos) << out;
  EXPECT_NE(out.find("\nTargets of ours"), std::string::npos) << out;
  EXPECT_NE(out.find("rebootstraps                worst     <=     0        -         0  met\n"), std::string::npos)
      << out;
  EXPECT_EQ(ReadFile(folder / "out/bench_odometry/odometry.txt"), out);
  for (const std::string name : {"error", "drift"}) {
    const fs::path plot = folder / ("out/bench_odometry/odometry_" + name);
    EXPECT_NE(ReadFile(plot.string() + ".gnuplot").find("plot "), std::string::npos) << name;
    if (std::system("gnuplot --version >/dev/null 2>&1") == 0) {
      EXPECT_NE(ReadFile(plot.string() + ".svg").find("</svg>"), std::string::npos) << name;
    }
  }
}

TEST_F(BenchOdometryTest, OnlyWhatHasChangedIsDoneAgain) {
  WriteScene("swift");
  Write("mine.yaml", "odometry:\n  final_refinement: false\n");
  const std::string words = "--seeds 1 --config ours --config mine.yaml swift.yaml";
  ASSERT_EQ(Bench(words), 0) << err;
  EXPECT_TRUE(Simulated());
  EXPECT_EQ(CountRuns(), 2) << err;
  ExpectNothingToDo(words);
  Write("mine.yaml", "odometry:\n  window_refinement: false\n");
  ASSERT_EQ(Bench(words), 0) << err;
  EXPECT_EQ(CountRuns(), 1) << "only that of the file\n" << err;
  ASSERT_EQ(Bench("--seeds 1 --set 'odometry.window=6 odometry.lag=3' swift.yaml"), 0) << err;
  EXPECT_EQ(CountRuns(), 1) << "only the variant\n" << err;
  EXPECT_EQ(Table("odometry.csv").at(1).at("config"), "odometry.window=6 odometry.lag=3");
}

TEST_F(BenchOdometryTest, BumpsAreComparedWithTheSameRoadWithoutThem) {
  WriteScene("bumps");
  ASSERT_EQ(Bench("--seeds 1 --config ours bumps.yaml"), 0) << err;
  const auto rows = Table("odometry.csv");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].at("scene") + ' ' + rows[1].at("scene"), "bumps:0.3 bumps_level:0.3");
  EXPECT_EQ(rows[0].at("mean_planar_percent"), rows[1].at("mean_planar_percent")) << "a slider meets no bumps";
  EXPECT_NE(out.find("error_over_that_of_level"), std::string::npos) << out;
  EXPECT_NE(out.find("         1  met\n"), std::string::npos) << out;
}

TEST_F(BenchOdometryTest, RecordingsPartsOfThemAndGivenTracks) {
  ASSERT_EQ(Run("track --events '" + Sample().string() + "' --no-plots --quiet --out '" + Path("tracked") + "'"), 0);
  fs::create_directories(folder / "given");
  fs::copy_file(folder / "tracked/tracks.txt", folder / "given/tracks.txt");
  fs::copy_file(Sample("street_gt.hdf5"), folder / "given/street_gt.hdf5");
  fs::copy_file(Sample("camchain-imucam-street.yaml"), folder / "given/camchain-imucam-street.yaml");
  const std::string sample = "--recording '" + Sample().string();
  ASSERT_EQ(Bench("--config ours --recording given " + sample + "' " + sample + ":0.2+1'"), 0) << err;
  EXPECT_FALSE(Simulated());
  const auto rows = Table("odometry.csv");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].at("scene") + ' ' + rows[1].at("scene") + ' ' + rows[2].at("scene"), "given street street:0.2+1");
  EXPECT_EQ(rows[0].at("mean_planar_percent"), rows[1].at("mean_planar_percent")) << "as the tracks are the same";
  EXPECT_EQ(rows[0].at("coverage_since_start_share"), rows[1].at("coverage_since_start_share"));
  EXPECT_EQ(rows[0].at("run_x_real_time"), "") << "nothing was tracked";
  EXPECT_GT(std::stod(rows[0].at("odometry_x_real_time")), 0.0);
  EXPECT_GT(std::stod(rows[0].at("sim3_ape_rmse_percent")), 0.0);
  EXPECT_NEAR(std::stod(rows[2].at("recorded_s")), 1.0, 0.05);
}

TEST_F(BenchOdometryTest, ARunThatFailsHasARow) {
  WriteScene("slider", "0.01");
  EXPECT_EQ(Bench("--seeds 1 --config ours slider.yaml"), 1) << out;
  const auto rows = Table("odometry.csv");
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_TRUE(rows[0].at("failure").starts_with("exit code 6: ")) << rows[0].at("failure");
  EXPECT_EQ(rows[0].at("mean_planar_percent"), "");
  EXPECT_NE(out.find("missed: 1 of 1 failed"), std::string::npos) << out;
}

TEST_F(BenchOdometryTest, WrongWordsAreRefusedBeforeAnythingIsDone) {
  WriteScene("swift");
  fs::create_directories(folder / "given");
  Write("given/tracks.txt", "1 0 1 1\n");
  Write("odd.yaml", "odometry:\n  windows: 3\n");
  for (const std::string words :
       {"--speed 3", "--seeds 1,", "--threads x", "--set", "--set odometry.windw=3 swift.yaml",
        "--set odometry.window swift.yaml", "--config nothing swift.yaml", "--config odd.yaml swift.yaml",
        "--config paper --config paper swift.yaml", "nowhere", "--recording nowhere", "--recording given:1"}) {
    EXPECT_EQ(Bench(words), 2) << words;
    EXPECT_TRUE(err.starts_with("bench_odometry: error: ")) << words << ": " << err;
    EXPECT_EQ(std::ranges::count(err, '\n'), 1) << err;
  }
  EXPECT_FALSE(fs::exists(folder / "out"));
  EXPECT_EQ(Bench("--help"), 0);
  EXPECT_NE(out.find("--ablation"), std::string::npos);
}

TEST_F(BenchOdometryTest, AllIngredientsCanBeSwitchedOff) {
  WriteScene("swift");
  ASSERT_EQ(Bench("--seeds 1 --ablation swift.yaml"), 0) << err;
  const auto rows = Table("ablation.csv");
  ASSERT_GT(rows.size(), 10u);
  EXPECT_EQ(rows[0].at("config"), "ours");
  EXPECT_EQ(out.find("Targets"), std::string::npos);
}

class PaperConfigurationTest : public EvoRunTest {};

TEST_F(PaperConfigurationTest, FollowsTheBundledStreet) {
  const std::string config = "'" EVO_SOURCE_DIR "/configs/paper.yaml'";
  ASSERT_EQ(Run("config --check " + config), 0) << err;
  ASSERT_EQ(Run("run --config " + config + " --no-plots --quiet --events '" + Sample().string() + "' --out '" +
                Path("paper") + "'"),
            0)
      << err;
  const std::string manifest = ReadFile(folder / "paper/manifest.json");
  for (const std::string key :
       {"ego_motion", "follow_jolts", "restore_shake", "window_refinement", "final_refinement", "refine"}) {
    EXPECT_NE(manifest.find("\"" + key + "\": false"), std::string::npos) << key;
  }
  EXPECT_NE(out.find("coverage 100.0 %"), std::string::npos) << out;
}

}  // namespace
}  // namespace evo::app
