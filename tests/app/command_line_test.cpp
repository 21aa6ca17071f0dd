// The program as users call it: exit codes, the one line on stderr, the files it leaves.
#include <iterator>
#include <nlohmann/json.hpp>

#include "app/evo_run.hpp"

namespace evo::app {
namespace {

namespace fs = std::filesystem;

class CommandLineTest : public EvoRunTest {
 protected:
  static std::string Data(const std::string& name) {
    return std::string("'") + EVO_SOURCE_DIR + "/tests/evaluation/data/" + name + "'";
  }

  std::string Evaluate(const std::string& estimate, const std::string& truth, const std::string& more = "") {
    return "evaluate --no-plots --estimate " + Data(estimate) + " --ground-truth " + Data(truth) + " --out '" +
           (folder / "result").string() + "' " + more;
  }
};

TEST_F(CommandLineTest, HelpShowsExamplesOfEveryCommand) {
  EXPECT_EQ(Run("--help"), 0);
  const std::string overview = out;
  for (const std::string command : {"run", "track", "odometry", "evaluate", "report", "simulate", "info", "config"}) {
    EXPECT_NE(overview.find("\n  " + command + " "), std::string::npos) << overview;
    ASSERT_EQ(Run(command + " --help"), 0);
    EXPECT_NE(out.find("\nExamples:\n"), std::string::npos) << out;
    EXPECT_NE(out.find("\n  evo-run " + command + " "), std::string::npos) << out;
  }
  EXPECT_EQ(Run("--version"), 0);
  EXPECT_TRUE(out.starts_with("evo-run "));
}

TEST_F(CommandLineTest, EvaluateHelpShowsEachUse) {
  ASSERT_EQ(Run("evaluate --help"), 0);
  for (const char* use : {"\n  evo-run evaluate --estimate out/trajectory.txt", "kitti_lengths_m=", "--rpe 1s,10m",
                          "\n  evo-run evaluate --tracks out/tracks.txt", "--true-tracks true_tracks.txt"}) {
    EXPECT_NE(out.find(use), std::string::npos) << use;
  }
}

TEST_F(CommandLineTest, UsageErrorsExitWithTwo) {
  for (const char* words : {"", "fly", "--fly", "config", "config --print --check x.yaml", "evaluate"}) {
    EXPECT_EQ(Refusal(words), 2) << words;
  }
  EXPECT_EQ(Refusal(Evaluate("gt.txt", "gt.txt", "--align best")), 2);
  EXPECT_EQ(Refusal(Evaluate("gt.txt", "gt.txt", "--up sideways")), 2);
  EXPECT_EQ(Refusal(Evaluate("gt.txt", "gt.txt", "--ground-truth-source gps")), 2);
  EXPECT_EQ(Refusal(Evaluate("gt.txt", "gt.txt", "--from-stamp soon")), 2);
  EXPECT_EQ(Refusal(Evaluate("gt.txt", "gt.txt", "--from-stamp 5 --to-stamp 4")), 2);
  EXPECT_EQ(Refusal(Evaluate("gt.txt", "gt.txt", "-v -q")), 2);
  for (const char* mistake : {"--rpe 10", "--rpe 10x", "--rpe-pairs some", "--project zz", "--forward back",
                              "--association best", "--max-difference=-1", "--time-offset=nan", "--max-difference nan",
                              "--max-difference x", "--max-difference 0.02", "--align none:5", "--align sim3:0"}) {
    EXPECT_EQ(Refusal(Evaluate("gt.txt", "gt.txt", mistake)), 2) << mistake;
  }
  EXPECT_FALSE(fs::exists(folder / "result"));
}

TEST_F(CommandLineTest, ConfigurationErrorsExitWithThree) {
  EXPECT_EQ(Refusal(Evaluate("gt.txt", "gt.txt", "--set evaluation.chrod_m=2")), 3);
  EXPECT_NE(err.find("evaluation.chord_m"), std::string::npos) << err;
  const fs::path file = folder / "bad.yaml";
  std::ofstream(file) << "evaluation:\n  gap_s: 1\n  chord_m: -1\n";
  EXPECT_EQ(Refusal("config --check '" + file.string() + "'"), 3);
  EXPECT_NE(err.find("bad.yaml:3"), std::string::npos) << err;
}

TEST_F(CommandLineTest, RelativeErrorsOverGivenDistances) {
  ASSERT_EQ(Run(Evaluate("est_drift.txt", "gt.txt", "--association nearest --rpe 10m,0.5s --rpe-pairs all")), 0) << err;
  EXPECT_EQ(err, "");
  const std::string metrics = ReadFile(folder / "result" / "metrics.csv");
  // The digits that evo prints.
  EXPECT_NE(metrics.find("gt,sim3,rpe,translation,m,0.5,s,all,"), std::string::npos) << metrics;
  EXPECT_EQ(Run(Evaluate("est_drift.txt", "gt.txt", "--align none --association nearest --rpe 10m --force")), 0) << err;
  EXPECT_NE(
      ReadFile(folder / "result" / "metrics.csv").find("gt,none,rpe,translation,m,10,m,consecutive,39,0.085660127773"),
      std::string::npos);
  EXPECT_NE(ReadFile(folder / "result" / "summary.csv").find(",10m,0.085660128,"), std::string::npos);
}

TEST_F(CommandLineTest, DeltaLongerThanThePathIsSkippedOrRefused) {
  ASSERT_EQ(Run(Evaluate("gt.txt", "gt.txt", "--align none --set evaluation.rpe_deltas=1f,9000m")), 0) << err;
  EXPECT_NE(ReadFile(folder / "result" / "metrics.csv").find(",9000,m,consecutive,0,,,,,,,\n"), std::string::npos);
  EXPECT_EQ(Refusal(Evaluate("gt.txt", "gt.txt", "--align none --rpe 9000m --force")), 5);
  EXPECT_NE(err.find("9000m"), std::string::npos) << err;
  EXPECT_EQ(Refusal(Evaluate("gt.txt", "gt.txt", "--set evaluation.rpe_deltas=9 --force")), 3);
}

TEST_F(CommandLineTest, KittiPosesAreAssociatedByNumber) {
  ASSERT_EQ(Run(Evaluate("kitti_est.txt", "kitti_gt.txt", "--rpe 100m")), 0) << err;
  EXPECT_TRUE(out.starts_with("path 1229.41 m, up -y\n")) << out;
  EXPECT_TRUE(ReadFile(folder / "result" / "errors.csv").starts_with("frame,distance,"));
  EXPECT_EQ(Refusal(Evaluate("kitti_est.txt", "gt.txt", "--force")), 4);
  EXPECT_EQ(Refusal(Evaluate("gt.txt", "kitti_gt.txt", "--force")), 4);
  for (const char* words : {"--rpe 1s", "--align sim3:5s", "--association nearest", "--time-offset=1"}) {
    EXPECT_EQ(Refusal(Evaluate("kitti_est.txt", "kitti_gt.txt", std::string(words) + " --force")), 2) << words;
  }
  const std::string shorter = Write("short.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  EXPECT_EQ(Refusal("evaluate --no-plots --estimate " + Quote(shorter) + " --ground-truth " + Data("kitti_gt.txt") +
                    " --out " + Quote(folder / "other")),
            4);
  EXPECT_NE(err.find("has 1 and the ground truth 1600"), std::string::npos) << err;
}

TEST_F(CommandLineTest, PrintedConfigurationPassesTheCheck) {
  ASSERT_EQ(Run("config --print --set evaluation.chord_m=2.5"), 0);
  EXPECT_NE(out.find("chord_m: 2.5"), std::string::npos);
  std::ofstream(folder / "printed.yaml") << out;
  EXPECT_EQ(Run("config --check '" + (folder / "printed.yaml").string() + "'"), 0);
}

TEST_F(CommandLineTest, MarkdownListsTheParametersOfFilesAndScenes) {
  ASSERT_EQ(Run("config --markdown"), 0);
  for (const char* text : {"# Parameters\n", "\n### tracker\n", "\n| `tracker.features` | `150` |",
                           "\n### odometry.pose\n", "\n| `scene.kind` | `street` |", "\n| `output.start_s` |"}) {
    EXPECT_NE(out.find(text), std::string::npos) << text;
  }
  EXPECT_EQ(Refusal("config --markdown --print"), 2);
}

TEST_F(CommandLineTest, DefaultConfigurationFileIsUpToDate) {
  ASSERT_EQ(Run("config --print"), 0);
  EXPECT_EQ(out, ReadFile(EVO_SOURCE_DIR "/configs/default.yaml"))
      << "regenerate it: evo-run config --print > configs/default.yaml";
  EXPECT_EQ(Run("config --check '" EVO_SOURCE_DIR "/configs/default.yaml'"), 0);
}

TEST_F(CommandLineTest, FullDiskOfStandardOutputIsReported) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  EXPECT_EQ(Run("config --print >/dev/full"), 8);
  EXPECT_NE(err.find("standard output"), std::string::npos) << err;
}

TEST_F(CommandLineTest, InputErrorsHaveTheirExitCodes) {
  EXPECT_EQ(Refusal(Evaluate("absent.txt", "gt.txt")), 4);
  EXPECT_EQ(Refusal(Evaluate("reference.csv", "gt.txt")), 4);
  EXPECT_EQ(Refusal(Evaluate("nooverlap.txt", "gt.txt")), 5);
  EXPECT_EQ(
      Refusal(Evaluate("est_drift.txt", "gt.txt", "--association nearest --set evaluation.max_difference_s=0.002")), 5);
  for (const char* file : {"line.txt", "still.txt", "two.txt"}) {
    EXPECT_EQ(Refusal(Evaluate(file, file, "--align se3")), 7) << file;
  }
  EXPECT_FALSE(fs::exists(folder / "result"));
}

TEST_F(CommandLineTest, EvaluateWritesItsTablesAndAManifest) {
  ASSERT_EQ(Run(Evaluate("est_drift.txt", "gt.txt", "--align none,first:5 --association nearest --sequence drive")), 0)
      << err;
  EXPECT_NE(out.find("path 429.11 m"), std::string::npos) << out;
  EXPECT_NE(ReadFile(folder / "result" / "summary.csv").find("\ndrive,none,1.000000000,586,"), std::string::npos);
  EXPECT_TRUE(fs::exists(folder / "result" / "errors.csv"));
  EXPECT_TRUE(fs::exists(folder / "result" / "errors_first-5.csv"));
  EXPECT_TRUE(fs::exists(folder / "result" / "metrics.csv"));
  EXPECT_EQ(nlohmann::json::parse(ReadFile(folder / "result" / "summary.json")).size(), 2u);
  const auto manifest = nlohmann::json::parse(ReadFile(folder / "result" / "manifest.json"));
  EXPECT_EQ(manifest["counts"]["matched_poses"], 586);
  EXPECT_EQ(manifest["parameters"]["evaluation"]["association"], "nearest");
  EXPECT_EQ(manifest["inputs"][0]["sha256"].get<std::string>().size(), 64u);
  EXPECT_TRUE(fs::exists(folder / "result" / "tables" / "errors.tex"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "result"), {}), 7);
}

TEST_F(CommandLineTest, EarlierResultsAreKeptUnlessForced) {
  const std::string words = Evaluate("est_drift.txt", "gt.txt");
  ASSERT_EQ(Run(words), 0) << err;
  const std::string before = ReadFile(folder / "result" / "summary.csv");
  EXPECT_EQ(Refusal(words + " --align none"), 8);
  EXPECT_EQ(ReadFile(folder / "result" / "summary.csv"), before);
  EXPECT_EQ(Run(words + " --force"), 0) << err;
  EXPECT_EQ(ReadFile(folder / "result" / "summary.csv"), before);
  EXPECT_EQ(Run(words + " --force --align none"), 0) << err;
  EXPECT_NE(ReadFile(folder / "result" / "summary.csv"), before);
}

TEST_F(CommandLineTest, UnusableOutputFolderIsRefusedBeforeWork) {
  std::ofstream(folder / "result") << "a file";
  EXPECT_EQ(Refusal(Evaluate("absent.txt", "gt.txt")), 8);
}

}  // namespace
}  // namespace evo::app
