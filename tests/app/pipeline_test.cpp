// All stages from events to the error report on the bundled sequences.
#include <nlohmann/json.hpp>

#include "app/pipeline.hpp"
#include "evo/io/track_io.hpp"

namespace evo::app {
namespace {

namespace fs = std::filesystem;

TEST_F(PipelineTest, DayMeetsItsBounds) {
  ASSERT_EQ(Run("run --events " + Quote(Sample()) + " --draw-every 1" + Out("result")), 0) << err;
  ExpectQuality("result", {.path_m = 5.83, .origin_scale_percent = 0.4, .sim3_percent = 0.1, .lifetime_frames = 15.0});
  for (const char* name : {"tracks.txt", "trajectory.txt", "map.ply", "errors.csv", "errors_sim3.csv", "summary.json",
                           "plots/trajectory.gp", "plots/axes.gp", "plots/errors.gp", "plots/errors_distance.gp",
                           "plots/errors_sim3.gp", "plots/lifetime.gp", "plots/lifetime_seconds.gp",
                           "plots/live_features.gp", "tables/lifetime.tex", "tables/errors.tex"}) {
    EXPECT_TRUE(fs::exists(folder / "result" / name)) << name;
  }
  EXPECT_EQ(CountFiles(folder / "result" / "images"), 2 * 5);  // at 0 and 1 s, four frames and their sheet each
  const auto manifest = nlohmann::json::parse(ReadFile(folder / "result" / "manifest.json"));
  EXPECT_EQ(manifest["counts"]["events"], 673521);
  EXPECT_EQ(manifest["inputs"].size(), 3u);
  EXPECT_TRUE(manifest["rebootstraps"].empty());
  EXPECT_NE(out.find("sim3"), std::string::npos) << out;
  // What was seen: nothing out of the ordinary.
  EXPECT_GE(manifest["seen"]["coverage"].get<double>(), 0.98);  // the first of 74 frames has no pose
  EXPECT_GT(manifest["seen"]["live_features_median"].get<double>(), 100.0);
  EXPECT_TRUE(manifest["warnings"].empty()) << manifest["warnings"];
  for (const char* line : {"\nfeatures   ", "\ncoverage   "}) EXPECT_NE(out.find(line), std::string::npos) << out;
  EXPECT_EQ(out.find("\nwarning    "), std::string::npos) << out;
}

TEST_F(PipelineTest, NightMeetsItsBounds) {
  ASSERT_EQ(Run("run --no-plots --events " + Quote(BundledSequence("night")) + Out("result")), 0) << err;
  ExpectQuality("result", {.path_m = 7.48, .origin_scale_percent = 0.8, .sim3_percent = 0.25, .lifetime_frames = 14.0});
}

TEST_F(PipelineTest, OutliersAreRejectedWithAllTheirObservations) {
  // The spline fits all tracks at once and would change the others.
  const std::string words = "track " + WithoutTruth() + "-q --set tracker.rotation_spline=false";
  ASSERT_EQ(Run(words + " --set tracker.rejection_ratio=0" + Out("all")), 0) << err;
  ASSERT_EQ(Run(words + " --set tracker.rejection_ratio=0.2" + Out("kept")), 0) << err;
  std::map<std::int64_t, events::Tracks> all, kept;
  for (const auto& observation : io::ReadTracks(folder / "all" / "tracks.txt"))
    all[observation.id].push_back(observation);
  for (const auto& observation : io::ReadTracks(folder / "kept" / "tracks.txt"))
    kept[observation.id].push_back(observation);
  std::size_t rejected = 0;
  for (const auto& [id, track] : all) {
    if (!kept.contains(id)) {
      ++rejected;
      EXPECT_GT(track.size(), 10u) << "too young to be judged";
      continue;
    }
    ASSERT_EQ(kept[id].size(), track.size()) << id;
    for (std::size_t i = 0; i < track.size(); ++i) EXPECT_EQ(kept[id][i].x, track[i].x);
  }
  EXPECT_EQ(kept.size() + rejected, all.size());
  EXPECT_GT(rejected, 10u);
  EXPECT_LT(rejected, all.size() / 4);
}

TEST_F(PipelineTest, HandheldMeetsItsBounds) {
  ASSERT_EQ(Run("run --no-plots --events " + Quote(BundledSequence("handheld")) + Out("result")), 0) << err;
  ExpectQuality("result", {.path_m = 0.32, .origin_scale_percent = 3.0, .sim3_percent = 0.5, .lifetime_frames = 15.0});
}

TEST_F(PipelineTest, CameraHeightGivesTheScale) {
  const std::string height = " --set odometry.ground.camera_height_m=";
  ASSERT_EQ(Run("run --no-plots --events " + Quote(Sample()) + height + "1.5" + Out("metres")), 0) << err;
  EXPECT_NEAR(std::stod(Summary("metres", "origin-scale")["scale"]), 1.0, 0.02);
  EXPECT_EQ(nlohmann::json::parse(ReadFile(folder / "metres" / "manifest.json"))["scale"], "ground");
  // A hand-held camera does not drive over a road.
  ASSERT_EQ(Run("run --no-plots --events " + Quote(BundledSequence("handheld")) + height + "1.5" + Out("hand")), 0)
      << err;
  EXPECT_NE(err.find("warning"), std::string::npos) << err;
  EXPECT_EQ(nlohmann::json::parse(ReadFile(folder / "hand" / "manifest.json"))["scale"], "arbitrary");
}

TEST_F(PipelineTest, SameBytesForAnyNumberOfThreadsAndWithoutTruth) {
  ASSERT_EQ(Run("run --no-plots --threads 1 --to 0.9 --events " + Quote(Sample()) + Out("1")), 0) << err;
  for (const std::string other : {"2", "2 again", "3"}) {
    ASSERT_EQ(Run("run " + WithoutTruth() + "--to 0.9 --threads " + other[0] + Out(other)), 0) << err;
    ExpectSameBytes("1", other, {"tracks.txt", "lifetime.csv", "trajectory.txt", "map.ply"});
    EXPECT_FALSE(fs::exists(folder / other / "summary.csv"));
  }
}

TEST_F(PipelineTest, SameBytesWithoutOpenCvsVectorCode) {
  ASSERT_EQ(Run("run " + WithoutTruth() + "--to 0.9" + Out("this")), 0) << err;
  ASSERT_EQ(Run("run " + WithoutTruth() + "--to 0.9" + Out("older"), "export OPENCV_CPU_DISABLE=AVX2,FMA3;"), 0) << err;
  ExpectSameBytes("this", "older", {"tracks.txt", "lifetime.csv", "trajectory.txt", "map.ply"});
}

TEST_F(PipelineTest, KltBaselineRunsFromEndToEnd) {
  const std::string klt = " --set tracker.method=klt --threads ";
  ASSERT_EQ(Run("run -q --draw-every 1 --events " + Quote(Sample()) + Out("klt") + klt + "1"), 0) << err;
  EXPECT_NE(ReadFile(folder / "klt" / "tracks.txt").find("newest 30000 events"), std::string::npos);
  EXPECT_GT(MeanLifetime("klt"), 10.0);
  EXPECT_GE(std::stod(Summary("klt", "sim3")["coverage"]), 0.8);
  EXPECT_EQ(CountFiles(folder / "klt" / "images"), 2 * 5);
  ASSERT_EQ(Run("track " + WithoutTruth() + Out("older") + klt + "3", "export OPENCV_CPU_DISABLE=AVX2,FMA3;"), 0)
      << err;
  ExpectSameBytes("klt", "older", {"tracks.txt", "lifetime.csv"});
}

TEST_F(PipelineTest, StagesOneByOneGiveTheSameBytes) {
  ASSERT_EQ(Run("run --no-plots --to 0.9 --events " + Quote(Sample()) + Out("whole")), 0) << err;
  ASSERT_EQ(Run("track " + WithoutTruth() + "--to 0.9" + Out("stages")), 0) << err;
  fs::remove(folder / "stages" / "manifest.json");  // each command leaves its own
  ASSERT_EQ(Run("odometry --tracks " + Quote(folder / "stages" / "tracks.txt") + " --calibration " +
                Quote(Sample("camchain-imucam-street.yaml")) + Out("stages")),
            0)
      << err;
  ExpectSameBytes("whole", "stages",
                  {"tracks.txt", "lifetime.csv", "trajectory.txt", "map.ply", "pose_covariance.csv"});
  const std::string evaluate = "evaluate --no-plots --estimate " + Quote(folder / "stages" / "trajectory.txt") +
                               " --ground-truth " + Quote(Sample("street_gt.hdf5")) + " --covariances ";
  ASSERT_EQ(Run(evaluate + Quote(folder / "stages" / "pose_covariance.csv") + Out("judged")), 0) << err;
  const std::string consistency = Summary("whole", "origin-scale")["nees_pose"];
  EXPECT_FALSE(consistency.empty());
  EXPECT_EQ(Summary("judged", "origin-scale")["nees_pose"].substr(0, 6), consistency.substr(0, 6));
  EXPECT_EQ(Refusal(evaluate + Quote(folder / "stages" / "trajectory.txt") + Out("refused")), 4);
}

TEST_F(PipelineTest, CovariancesAreConsistentOnSimulatedDrives) {
  // The squared error of each drive's last poses has six degrees of freedom, those before err with them: 18 in all. The
  // bounds are those of chi-squared, over its degrees of freedom, at 0.1 % to either side.
  constexpr int kDrives = 3;
  constexpr double kLowest = 0.27, kHighest = 2.35;
  double mean = 0.0;
  for (int seed = 31; seed < 31 + kDrives; ++seed) {
    const std::string drive = "drive " + std::to_string(seed);
    ASSERT_EQ(Run("simulate -q " + Quote(std::string(EVO_SOURCE_DIR) + "/configs/scenes/driving_day.yaml") +
                  " --from 20 --duration 2 --seed " + std::to_string(seed) +
                  " --set simulation.depth_hz=0 --set simulation.image_hz=0 --set simulation.samples=1" + Out(drive)),
              0)
        << err;
    ASSERT_EQ(Run("run -q --no-plots --events " + Quote(folder / drive) + Out(drive + " run")), 0) << err;
    mean += std::stod(Summary(drive + " run", "origin-scale")["nees_pose"]) / kDrives;
  }
  EXPECT_GT(mean, kLowest) << "they are too large";
  EXPECT_LT(mean, kHighest) << "they are too small";
}

}  // namespace
}  // namespace evo::app
