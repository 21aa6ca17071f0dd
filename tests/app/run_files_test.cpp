// The files that track, run and evaluate leave, replace and remove.
#include <signal.h>

#include <chrono>
#include <thread>

#include "app/pipeline.hpp"

namespace evo::app {
namespace {

namespace fs = std::filesystem;

using RunFilesTest = PipelineTest;

TEST_F(RunFilesTest, FourFramesInTheMiddleAreDrawnWithPlots) {
  const std::string words = "track -q --to 0.4 --events " + Quote(Sample()) + Out("result");
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

TEST_F(RunFilesTest, DrawingsStartWithTheInterval) {
  ASSERT_EQ(Run("track -q --no-plots --draw-every 0.2 --from 0.6 --to 1 --events " + Quote(Sample()) + Out("result")),
            0);
  std::vector<std::string> sheets = FileNames(folder / "result" / "images");
  std::erase_if(sheets, [](const std::string& name) { return name.starts_with("frame_"); });
  EXPECT_EQ(sheets, (std::vector<std::string>{"four_frames_0000.620s.png", "four_frames_0000.800s.png"}));
}

TEST_F(RunFilesTest, OverdueDrawingsFollowThePresentOne) {
  ASSERT_EQ(Run("track -q --no-plots --draw-every 0.001 --to 0.25 --events " + Quote(Sample()) + Out("result")), 0);
  std::vector<std::string> sheets = FileNames(folder / "result" / "images");
  const auto frames = std::erase_if(sheets, [](const std::string& name) { return name.starts_with("frame_"); });
  EXPECT_EQ(sheets, (std::vector<std::string>{"four_frames_0000.020s.png", "four_frames_0000.100s.png",
                                              "four_frames_0000.180s.png"}));
  EXPECT_EQ(frames, 12u);  // each once
}

TEST_F(RunFilesTest, ForcedRunReplacesAllEarlierResults) {
  const std::string words = "run -q --to 0.8 --force " + Out("result") + " ";
  ASSERT_EQ(Run(words + "--events " + Quote(Sample()) + " --align origin,sim3,se3:10"), 0) << err;
  const fs::path result = folder / "result";
  for (const char* name : {"errors_se3-10.csv", "plots/errors_distance_sim3.gp", "images/frame_0000.360s.png"}) {
    EXPECT_TRUE(fs::exists(result / name)) << name;
  }
  for (const char* name : {"errors_mine.csv", "errors_sim3.txt", "plots/errors_mine.svg", "tables/mine.tex"}) {
    Write("result/" + std::string(name), "mine");
  }
  const auto now = CountFiles(result);
  EXPECT_EQ(Run(words + WithoutTruth() + "--ground-truth " + Quote(Sample("street_data.hdf5"))), 4);
  EXPECT_EQ(CountFiles(result), now) << "a wrong input is noticed before anything is removed";

  // Without ground truth there is no error that could be taken for the new trajectory's.
  ASSERT_EQ(Run(words + WithoutTruth()), 0) << err;
  EXPECT_EQ(FileNames(result), (std::vector<std::string>{"errors_mine.csv", "errors_sim3.txt", "images", "lifetime.csv",
                                                         "manifest.json", "map.ply", "plots", "pose_covariance.csv",
                                                         "tables", "tracks.txt", "trajectory.txt"}));
  EXPECT_EQ(FileNames(result / "plots"), std::vector<std::string>{"errors_mine.svg"});
  EXPECT_EQ(FileNames(result / "tables"), (std::vector<std::string>{"lifetime.tex", "mine.tex"}));
  EXPECT_EQ(CountFiles(result / "images"), 0);

  // A run that fails leaves no manifest, by which its folder is known to be complete.
  EXPECT_EQ(Run(words + WithoutTruth() + "--set odometry.bootstrap.min_disparity_px=200"), 6) << err;
  EXPECT_NE(err.find("; seen: "), std::string::npos) << "the error says what was seen: " << err;
  EXPECT_EQ(std::ranges::count(err, '\n'), 1) << err;
  EXPECT_FALSE(fs::exists(result / "manifest.json"));
  EXPECT_FALSE(fs::exists(result / "trajectory.txt"));
}

TEST_F(RunFilesTest, ForcedEvaluationReplacesAllEarlierResults) {
  const std::string data = std::string(EVO_SOURCE_DIR) + "/tests/evaluation/data/";
  const std::string words =
      "evaluate --force --ground-truth " + Quote(data + "gt.txt") + Out("result") + " --estimate ";
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

TEST_F(RunFilesTest, InterruptedRunLeavesNoPartialFile) {
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
