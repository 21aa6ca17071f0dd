// The whole way from events to the error report, on the bundled sequences.
#include <signal.h>

#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>
#include <vector>

#include "app/evo_run.hpp"
#include "evo/io/track_io.hpp"

namespace evo::app {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> SplitAtCommas(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line + ',');  // the last cell may be empty
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

class PipelineTest : public EvoRunTest {
 protected:
  /// Column by name of summary.csv's row of `alignment`.
  std::map<std::string, std::string> Summary(const std::string& result, const std::string& alignment) const {
    std::istringstream csv(ReadFile(folder / result / "summary.csv"));
    std::string line;
    std::getline(csv, line);
    const auto names = SplitAtCommas(line);
    std::map<std::string, std::string> row;
    while (std::getline(csv, line)) {
      const auto cells = SplitAtCommas(line);
      if (cells.size() != names.size() || cells[1] != alignment) continue;
      for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = cells[i];
    }
    return row;
  }

  double MeanLifetime(const std::string& result) const {
    const std::string csv = ReadFile(folder / result / "lifetime.csv");
    const std::string key = "\nmean,frames,,,";
    const auto found = csv.find(key);
    return found == std::string::npos ? 0.0 : std::stod(csv.substr(found + key.size()));
  }

  struct Bounds {
    double path_m = 0.0;
    double origin_scale_percent = 0.0;  ///< mean planar error
    double sim3_percent = 0.0;
    double lifetime_frames = 0.0;
  };

  /// Every frame has a pose, nothing was lost, errors are smaller and lives longer than the bounds.
  void ExpectQuality(const std::string& result, const Bounds& bounds) const {
    auto origin_scale = Summary(result, "origin-scale");
    auto sim3 = Summary(result, "sim3");
    ASSERT_FALSE(origin_scale.empty() || sim3.empty());
    EXPECT_EQ(origin_scale["rebootstraps"], "0");
    EXPECT_GE(std::stod(origin_scale["coverage"]), 0.99);
    EXPECT_NEAR(std::stod(origin_scale["path_m"]), bounds.path_m, 0.05 * bounds.path_m);
    EXPECT_LT(std::stod(origin_scale["mean_planar_percent"]), bounds.origin_scale_percent);
    EXPECT_LT(std::stod(sim3["mean_planar_percent"]), bounds.sim3_percent);
    EXPECT_GT(MeanLifetime(result), bounds.lifetime_frames);
  }

  /// Sorted.
  static std::vector<std::string> FileNames(const fs::path& directory) {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(directory)) names.push_back(entry.path().filename().string());
    std::ranges::sort(names);
    return names;
  }

  std::string To(const std::string& result) const { return " --out " + Quote(folder / result); }

  /// Events and calibration alone: no ground truth at hand.
  static std::string Blind() {
    return "--events " + Quote(Sample("street_data.hdf5")) + " --calibration " +
           Quote(Sample("camchain-imucam-street.yaml")) + " --no-plots ";
  }

  void ExpectSameBytes(const std::string& a, const std::string& b, const std::vector<std::string>& names) const {
    for (const auto& name : names) {
      const std::string content = ReadFile(folder / a / name);
      EXPECT_FALSE(content.empty()) << name;
      EXPECT_TRUE(content == ReadFile(folder / b / name)) << name << " differs between " << a << " and " << b;
    }
  }
};

TEST_F(PipelineTest, RunKeepsItsQuality) {
  ASSERT_EQ(Run("run --events " + Quote(Sample()) + " --draw-every 1" + To("result")), 0) << err;
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
}

TEST_F(PipelineTest, RunKeepsItsQualityAtNight) {
  ASSERT_EQ(Run("run --no-plots --events " + Quote(BundledSequence("night")) + To("result")), 0) << err;
  ExpectQuality("result", {.path_m = 7.48, .origin_scale_percent = 0.8, .sim3_percent = 0.25, .lifetime_frames = 14.0});
}

TEST_F(PipelineTest, OddTracksAreWithdrawnWithAllThatWasSeenOfThem) {
  const std::string alike = "track " + Blind() + "-q --set tracker.rotation_spline=false";  // which all tracks share
  ASSERT_EQ(Run(alike + " --set tracker.rejection_ratio=0" + To("all")), 0) << err;
  ASSERT_EQ(Run(alike + " --set tracker.rejection_ratio=0.2" + To("kept")), 0) << err;
  std::map<std::int64_t, events::Tracks> all, kept;
  for (const auto& observation : io::ReadTracks(folder / "all" / "tracks.txt"))
    all[observation.id].push_back(observation);
  for (const auto& observation : io::ReadTracks(folder / "kept" / "tracks.txt"))
    kept[observation.id].push_back(observation);
  std::size_t withdrawn = 0;
  for (const auto& [id, track] : all) {
    if (!kept.contains(id)) {
      ++withdrawn;
      EXPECT_GT(track.size(), 10u) << "too young to be judged";
      continue;
    }
    ASSERT_EQ(kept[id].size(), track.size()) << id;
    for (std::size_t i = 0; i < track.size(); ++i) EXPECT_EQ(kept[id][i].x, track[i].x);
  }
  EXPECT_EQ(kept.size() + withdrawn, all.size());
  EXPECT_GT(withdrawn, 10u);
  EXPECT_LT(withdrawn, all.size() / 4);
}

TEST_F(PipelineTest, RunKeepsItsQualityInTheHand) {
  ASSERT_EQ(Run("run --no-plots --events " + Quote(BundledSequence("handheld")) + To("result")), 0) << err;
  ExpectQuality("result", {.path_m = 0.32, .origin_scale_percent = 3.0, .sim3_percent = 0.5, .lifetime_frames = 15.0});
}

TEST_F(PipelineTest, TheCamerasHeightGivesTheScale) {
  const std::string height = " --set odometry.ground.camera_height_m=";
  ASSERT_EQ(Run("run --no-plots --events " + Quote(Sample()) + height + "1.5" + To("metres")), 0) << err;
  EXPECT_NEAR(std::stod(Summary("metres", "origin-scale")["scale"]), 1.0, 0.02);
  EXPECT_EQ(nlohmann::json::parse(ReadFile(folder / "metres" / "manifest.json"))["scale"], "ground");
  // A hand-held camera does not drive over a road.
  ASSERT_EQ(Run("run --no-plots --events " + Quote(BundledSequence("handheld")) + height + "1.5" + To("hand")), 0)
      << err;
  EXPECT_NE(err.find("warning"), std::string::npos) << err;
  EXPECT_EQ(nlohmann::json::parse(ReadFile(folder / "hand" / "manifest.json"))["scale"], "arbitrary");
}

TEST_F(PipelineTest, SameBytesForAnyNumberOfThreadsAndWithoutTheTruth) {
  ASSERT_EQ(Run("run --no-plots --threads 1 --to 0.9 --events " + Quote(Sample()) + To("1")), 0) << err;
  for (const std::string other : {"2", "2 again", "3"}) {
    ASSERT_EQ(Run("run " + Blind() + "--to 0.9 --threads " + other[0] + To(other)), 0) << err;
    ExpectSameBytes("1", other, {"tracks.txt", "lifetime.csv", "trajectory.txt", "map.ply"});
    EXPECT_FALSE(fs::exists(folder / other / "summary.csv"));
  }
}

TEST_F(PipelineTest, SameBytesWhateverVariantsOpenCvWouldChoose) {
  ASSERT_EQ(Run("run " + Blind() + "--to 0.9" + To("this")), 0) << err;
  ASSERT_EQ(Run("run " + Blind() + "--to 0.9" + To("older"), "export OPENCV_CPU_DISABLE=AVX2,FMA3;"), 0) << err;
  ExpectSameBytes("this", "older", {"tracks.txt", "lifetime.csv", "trajectory.txt", "map.ply"});
}

TEST_F(PipelineTest, TheBaselineRunsFromEndToEnd) {
  const std::string klt = " --set tracker.method=klt --threads ";
  ASSERT_EQ(Run("run -q --draw-every 1 --events " + Quote(Sample()) + To("klt") + klt + "1"), 0) << err;
  EXPECT_NE(ReadFile(folder / "klt" / "tracks.txt").find("newest 30000 events"), std::string::npos);
  EXPECT_GT(MeanLifetime("klt"), 10.0);
  EXPECT_GE(std::stod(Summary("klt", "sim3")["coverage"]), 0.8);
  EXPECT_EQ(CountFiles(folder / "klt" / "images"), 2 * 5);
  ASSERT_EQ(Run("track " + Blind() + To("older") + klt + "3", "export OPENCV_CPU_DISABLE=AVX2,FMA3;"), 0) << err;
  ExpectSameBytes("klt", "older", {"tracks.txt", "lifetime.csv"});
}

TEST_F(PipelineTest, StageByStageGivesWhatRunGives) {
  ASSERT_EQ(Run("run --no-plots --to 0.9 --events " + Quote(Sample()) + To("whole")), 0) << err;
  ASSERT_EQ(Run("track " + Blind() + "--to 0.9" + To("stages")), 0) << err;
  fs::remove(folder / "stages" / "manifest.json");  // each command leaves its own
  ASSERT_EQ(Run("odometry --tracks " + Quote(folder / "stages" / "tracks.txt") + " --calibration " +
                Quote(Sample("camchain-imucam-street.yaml")) + To("stages")),
            0)
      << err;
  ExpectSameBytes("whole", "stages",
                  {"tracks.txt", "lifetime.csv", "trajectory.txt", "map.ply", "pose_covariance.csv"});
  const std::string evaluate = "evaluate --no-plots --estimate " + Quote(folder / "stages" / "trajectory.txt") +
                               " --ground-truth " + Quote(Sample("street_gt.hdf5")) + " --covariances ";
  ASSERT_EQ(Run(evaluate + Quote(folder / "stages" / "pose_covariance.csv") + To("judged")), 0) << err;
  const std::string consistency = Summary("whole", "origin-scale")["nees_pose"];
  EXPECT_FALSE(consistency.empty());
  EXPECT_EQ(Summary("judged", "origin-scale")["nees_pose"].substr(0, 6), consistency.substr(0, 6));
  EXPECT_EQ(Refusal(evaluate + Quote(folder / "stages" / "trajectory.txt") + To("refused")), 4);
}

TEST_F(PipelineTest, CovariancesAreHonestOnSimulatedDrives) {
  // The squared error of each drive's last poses has six degrees of freedom, those before err with them: 18 in all. The
  // bounds are those of chi-squared, over its degrees of freedom, at 0.1 % to either side.
  constexpr int kDrives = 3;
  constexpr double kLowest = 0.27, kHighest = 2.35;
  double mean = 0.0;
  for (int seed = 31; seed < 31 + kDrives; ++seed) {
    const std::string drive = "drive " + std::to_string(seed);
    ASSERT_EQ(Run("simulate -q " + Quote(std::string(EVO_SOURCE_DIR) + "/configs/scenes/driving_day.yaml") +
                  " --from 20 --duration 2 --seed " + std::to_string(seed) +
                  " --set simulation.depth_hz=0 --set simulation.image_hz=0 --set simulation.samples=1" + To(drive)),
              0)
        << err;
    ASSERT_EQ(Run("run -q --no-plots --events " + Quote(folder / drive) + To(drive + " run")), 0) << err;
    mean += std::stod(Summary(drive + " run", "origin-scale")["nees_pose"]) / kDrives;
  }
  EXPECT_GT(mean, kLowest) << "they are too large";
  EXPECT_LT(mean, kHighest) << "they are too small";
}

TEST_F(PipelineTest, FourFramesInTheMiddleAreDrawnUnlessThereShallBeNoPlots) {
  const std::string words = "track -q --to 0.4 --events " + Quote(Sample()) + To("result");
  ASSERT_EQ(Run(words), 0) << err;
  const fs::path images = folder / "result" / "images";
  const std::vector<std::string> expected{"four_frames_0000.160s.png", "frame_0000.160s.png", "frame_0000.180s.png",
                                          "frame_0000.200s.png", "frame_0000.220s.png"};
  EXPECT_EQ(FileNames(images), expected);
  // An earlier run's images do not stay behind; what is not ours does.
  std::ofstream(images / "four_frames_0007.000s.png") << "earlier";
  std::ofstream(images / "frame_of_mine.png") << "mine";
  EXPECT_EQ(Refusal(words), 8);
  EXPECT_TRUE(fs::exists(images / "four_frames_0007.000s.png"));
  ASSERT_EQ(Run(words + " --no-plots --force"), 0) << err;
  EXPECT_EQ(FileNames(images), std::vector<std::string>{"frame_of_mine.png"});
}

TEST_F(PipelineTest, DrawingsFollowEachOtherFromTheStartOfTheInterval) {
  ASSERT_EQ(Run("track -q --no-plots --draw-every 0.2 --from 0.6 --to 1 --events " + Quote(Sample()) + To("result")),
            0);
  std::vector<std::string> sheets = FileNames(folder / "result" / "images");
  std::erase_if(sheets, [](const std::string& name) { return name.starts_with("frame_"); });
  EXPECT_EQ(sheets, (std::vector<std::string>{"four_frames_0000.620s.png", "four_frames_0000.800s.png"}));
}

TEST_F(PipelineTest, AForcedRunLeavesNothingOfTheOneBefore) {
  const std::string words = "run -q --to 0.8 --force " + To("result") + " ";
  ASSERT_EQ(Run(words + "--events " + Quote(Sample()) + " --align origin,sim3,se3:10"), 0) << err;
  const fs::path result = folder / "result";
  for (const char* name : {"errors_se3-10.csv", "plots/errors_distance_sim3.gp", "images/frame_0000.360s.png"}) {
    EXPECT_TRUE(fs::exists(result / name)) << name;
  }
  for (const char* name : {"errors_mine.csv", "errors_sim3.txt", "plots/errors_mine.svg", "tables/mine.tex"}) {
    Write("result/" + std::string(name), "mine");
  }
  const auto now = CountFiles(result);
  EXPECT_EQ(Run(words + Blind() + "--ground-truth " + Quote(Sample("street_data.hdf5"))), 4);
  EXPECT_EQ(CountFiles(result), now) << "a wrong input is noticed before anything is removed";

  // Without ground truth there is no error that could be taken for the new trajectory's.
  ASSERT_EQ(Run(words + Blind()), 0) << err;
  EXPECT_EQ(FileNames(result), (std::vector<std::string>{"errors_mine.csv", "errors_sim3.txt", "images", "lifetime.csv",
                                                         "manifest.json", "map.ply", "plots", "pose_covariance.csv",
                                                         "tables", "tracks.txt", "trajectory.txt"}));
  EXPECT_EQ(FileNames(result / "plots"), std::vector<std::string>{"errors_mine.svg"});
  EXPECT_EQ(FileNames(result / "tables"), (std::vector<std::string>{"lifetime.tex", "mine.tex"}));
  EXPECT_EQ(CountFiles(result / "images"), 0);

  // A run that fails leaves no manifest, by which its folder is known to be complete.
  EXPECT_EQ(Run(words + Blind() + "--set odometry.bootstrap.min_disparity_px=200"), 6) << err;
  EXPECT_FALSE(fs::exists(result / "manifest.json"));
  EXPECT_FALSE(fs::exists(result / "trajectory.txt"));
}

TEST_F(PipelineTest, AForcedEvaluationLeavesNothingOfTheOneBefore) {
  const std::string data = std::string(EVO_SOURCE_DIR) + "/tests/evaluation/data/";
  const std::string words = "evaluate --force --ground-truth " + Quote(data + "gt.txt") + To("result") + " --estimate ";
  ASSERT_EQ(Run(words + Quote(data + "est_drift.txt") + " --align none,sim3,sim3:2.5s,scale"), 0) << err;
  EXPECT_EQ(CountFiles(folder / "result"), 9 + 4 * 5 * 4);
  EXPECT_TRUE(fs::exists(folder / "result" / "errors_sim3-2.5s.csv"));
  EXPECT_EQ(Run(words + Quote(Write("empty.txt", "")) + " --no-plots"), 4);
  EXPECT_EQ(CountFiles(folder / "result"), 9 + 4 * 5 * 4) << "a wrong input is noticed before anything is removed";
  ASSERT_EQ(Run(words + Quote(data + "est_drift.txt") + " --align sim3,none --no-plots"), 0) << err;
  EXPECT_EQ(FileNames(folder / "result"),
            (std::vector<std::string>{"errors.csv", "errors_none.csv", "manifest.json", "metrics.csv", "plots",
                                      "summary.csv", "summary.json", "tables"}));
  EXPECT_EQ(CountFiles(folder / "result" / "plots"), 0);
}

TEST_F(PipelineTest, DrawingsThatAreDueDuringOneFollowIt) {
  ASSERT_EQ(Run("track -q --no-plots --draw-every 0.001 --to 0.25 --events " + Quote(Sample()) + To("result")), 0);
  std::vector<std::string> sheets = FileNames(folder / "result" / "images");
  const auto frames = std::erase_if(sheets, [](const std::string& name) { return name.starts_with("frame_"); });
  EXPECT_EQ(sheets, (std::vector<std::string>{"four_frames_0000.020s.png", "four_frames_0000.100s.png",
                                              "four_frames_0000.180s.png"}));
  EXPECT_EQ(frames, 12u);  // each once
}

TEST_F(PipelineTest, AnInterruptedRunLeavesNothingHalfWritten) {
  const fs::path images = folder / "result" / "images";
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const std::string error = Path("stderr");
    const std::string events = Sample().string();
    const std::string result = Path("result");
    if (!std::freopen(error.c_str(), "w", stderr)) ::_exit(1);
    ::execl(EVO_RUN, EVO_RUN, "run", "-q", "--events", events.c_str(), "--draw-every", "0.001", "--out", result.c_str(),
            static_cast<char*>(nullptr));
    ::_exit(1);
  }
  // One image after the other is written; the second file is there once the first is whole.
  for (int i = 0; i < 6000 && CountFiles(images) < 2; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  ::kill(child, SIGINT);
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status)) << "exit code " << WEXITSTATUS(status);
  EXPECT_EQ(WTERMSIG(status), SIGINT);
  EXPECT_EQ(ReadFile(folder / "stderr"), "evo-run: error: interrupted; results written so far are whole\n");
  EXPECT_GT(CountFiles(images), 0);
  for (const auto& entry : fs::recursive_directory_iterator(folder / "result")) {
    EXPECT_EQ(entry.path().string().find(".part"), std::string::npos) << entry.path();
  }
}

}  // namespace
}  // namespace evo::app
