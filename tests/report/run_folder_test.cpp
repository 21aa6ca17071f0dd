#include "evo/report/run_folder.hpp"

#include "report/run_fixtures.hpp"

namespace evo::report {
namespace {

using RunFolderTest = RunsTest;

TEST_F(RunFolderTest, ReadsTheResultsOfARun) {
  EvaluatedRun("day");
  Write("day/plots/b.svg", "<svg/>");
  Write("day/plots/a.svg", "<svg/>");
  Write("day/plots/a.pdf", "%PDF");
  Write("day/images/four_frames_1.png", "png");
  Write("day/images/frame_1.png", "png");
  Write("day/log.txt", "info: fine\nwarning: beware\n");
  const auto runs = ReadRunFolders({folder / "day"});
  ASSERT_EQ(runs.size(), 1u);
  EXPECT_EQ(runs[0].name, "day");
  EXPECT_EQ(runs[0].failure, "");
  EXPECT_EQ(runs[0].summary->rows.size(), 2u);
  EXPECT_EQ(runs[0].plots, (std::vector{folder / "day/plots/a.svg", folder / "day/plots/b.svg"}));
  EXPECT_EQ(runs[0].sheets, std::vector{folder / "day/images/four_frames_1.png"});
  EXPECT_EQ(runs[0].warnings, std::vector<std::string>{"warning: beware"});
}

TEST_F(RunFolderTest, ManifestReadsBackAsWritten) {
  WriteRunManifest("day", {{"evaluation.up", "auto"}, {"tracker.features", "150"}, {"odometry.pose.refine", "true"}});
  const Manifest manifest = ReadManifest(folder / "day" / "manifest.json");
  EXPECT_EQ(manifest.command_line, (std::vector<std::string>{"evo-run", "run", "it's"}));
  EXPECT_EQ(manifest.parameters,
            (Parameters{{"evaluation.up", "auto"}, {"tracker.features", "150"}, {"odometry.pose.refine", "true"}}));
  EXPECT_EQ(manifest.inputs.at(0).sha256, "abc");
  EXPECT_EQ(manifest.rebootstraps, std::vector<TimeNs>{1'500'000'000});
  EXPECT_EQ(manifest.counts.at(1).second, 7);
  EXPECT_DOUBLE_EQ(*RealTimeFactor(manifest), 2.5);
}

TEST_F(RunFolderTest, WhatWasSeenReadsBackAsWritten) {
  Manifest manifest;
  manifest.seen = {{"live_features_median", 148.0}, {"at_rest_ratio", 0.0123}};
  manifest.losses = {{1'900'000'000, 12, 9, 4}};
  manifest.warnings = {"nothing was tracked"};
  std::filesystem::create_directories(folder / "day");
  WriteManifest(folder / "day" / "manifest.json", manifest);
  const Manifest read = ReadManifest(folder / "day" / "manifest.json");
  EXPECT_EQ(read.seen, manifest.seen);
  EXPECT_EQ(read.warnings, manifest.warnings);
  const std::string text = ReadFile(folder / "day" / "manifest.json");
  EXPECT_NE(text.find("\"live_features_median\": 148,"), std::string::npos);
  EXPECT_NE(text.find("\"t\": \"1.900000000\""), std::string::npos);
}

TEST_F(RunFolderTest, SpeedIsUnknownWithoutTracking) {
  Manifest manifest;
  manifest.stages = {{"odometry", 1.0}};
  EXPECT_FALSE(RealTimeFactor(manifest));
  manifest.recorded_s = 3.0;
  EXPECT_DOUBLE_EQ(*RealTimeFactor(manifest), 3.0);
  manifest.stages.clear();
  EXPECT_FALSE(RealTimeFactor(manifest));
}

TEST_F(RunFolderTest, ReadsEachFolderOnceUnderAUniqueName) {
  EvaluatedRun("a/day");
  EvaluatedRun("b/day");
  EvaluatedRun("night");
  const auto runs = ReadRunFolders({folder / "a/day", folder / "night/", folder / "b/day", folder / "b/../a/day/."});
  ASSERT_EQ(runs.size(), 3u);
  EXPECT_EQ(runs[0].name, "a/day");
  EXPECT_EQ(runs[1].name, "night");
  EXPECT_EQ(runs[2].name, "b/day");
}

TEST_F(RunFolderTest, AFailureIsOneLine) {
  const auto runs = ReadRunFolders({FailedRun("a", "exit code 4: no such file\n\nmore\n"), FailedRun("b", "\n")});
  EXPECT_EQ(runs[0].failure, "exit code 4: no such file; more");
  EXPECT_NE(runs[1].failure, "");
}

TEST_F(RunFolderTest, IncompleteRunsHaveFailed) {
  EvaluatedRun("day");
  std::filesystem::remove(folder / "day" / "manifest.json");
  const auto runs = ReadRunFolders({folder / "day"});
  EXPECT_NE(runs[0].failure.find("manifest.json"), std::string::npos);
  EXPECT_FALSE(runs[0].summary);
}

TEST_F(RunFolderTest, OtherFoldersAreRefused) {
  EXPECT_NE(Refusal({folder / "absent"}).find("absent: no such folder"), std::string::npos);
  EXPECT_NE(Refusal({Write("file", "x")}).find("file: no such folder"), std::string::npos);
  Write("other/readme.txt", "x");
  EXPECT_NE(Refusal({folder / "other"}).find("other: holds no manifest.json"), std::string::npos);
}

TEST_F(RunFolderTest, CorruptFilesAreRefusedWithFileAndLine) {
  const auto summary = [&](const std::string& text) { return Refusal({EvaluatedRun("day", {}, text)}); };
  EXPECT_NE(summary("sequence,alignment,coverage\nday,sim3\n").find("summary.csv:2: "), std::string::npos);
  EXPECT_NE(summary("sequence,coverage\nday,1\n").find("summary.csv:1: "), std::string::npos);
  EXPECT_NE(summary("sequence,alignment\n").find("summary.csv:1: "), std::string::npos);
  EXPECT_NE(summary("alignment,coverage\nnone,1\nsim3,nan\n").find("summary.csv:3: coverage"), std::string::npos);
  EXPECT_NE(summary("alignment,coverage\nsim3,1\nsim3,1\n").find("summary.csv:3: "), std::string::npos);

  const auto manifest = [&](const std::string& text) {
    return Refusal({Write("night/manifest.json", text).parent_path()});
  };
  EXPECT_NE(manifest("{\n \"version\": \"1\",\n").find("manifest.json:3: "), std::string::npos);
  EXPECT_NE(manifest("").find("manifest.json:1: "), std::string::npos);
  EXPECT_NE(manifest("[]").find("manifest.json: is not a manifest"), std::string::npos);
  EXPECT_NE(manifest(R"({"version":"1","command_line":[],"inputs":[],"counts":5})").find("counts"), std::string::npos);

  WriteRunManifest("evening", {});
  const auto lifetimes = [&](const std::string& text) {
    return Refusal({Write("evening/lifetime.csv", text).parent_path()});
  };
  EXPECT_NE(lifetimes("a,b\n").find("lifetime.csv:1: "), std::string::npos);
  EXPECT_NE(lifetimes("quantity,unit,value\nmean,frames,many\n").find("lifetime.csv:2: "), std::string::npos);
  EXPECT_NE(lifetimes("quantity,unit,value\nmean,frames,4\n").find("rows are missing"), std::string::npos);
}

}  // namespace
}  // namespace evo::report
