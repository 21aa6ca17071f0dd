#include "evo/report/figures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <span>
#include <sstream>

#include "report/fixtures.hpp"

namespace evo::report {
namespace {

namespace fs = std::filesystem;

using FiguresTest = ReportTest;

bool HaveGnuplot() { return std::system("command -v gnuplot >/dev/null 2>&1") == 0; }

/// Lines of a data file between comments and empty lines.
std::vector<std::vector<std::string>> Blocks(const std::string& data) {
  std::vector<std::vector<std::string>> blocks(1);
  std::istringstream lines(data);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('#')) continue;
    if (!line.empty()) {
      blocks.back().push_back(line);
    } else if (!blocks.back().empty()) {
      blocks.emplace_back();
    }
  }
  return blocks;
}

TEST_F(FiguresTest, TrajectoryIsATopViewInterruptedAtGaps) {
  const auto evaluation = SampleEvaluation();  // MVSEC axes: right is x, away is z
  const Figure figure = TrajectoryFigure("t", evaluation, evaluation.alignments[0]);
  const auto blocks = Blocks(figure.data);
  ASSERT_EQ(blocks.size(), 3u);  // truth, estimate before and after its gap
  EXPECT_EQ(blocks[0].size(), 201u);
  EXPECT_EQ(blocks[1].size(), 81u);
  EXPECT_EQ(blocks[2].size(), 101u);
  EXPECT_EQ(blocks[2].back(), "10 0 0 98");
  EXPECT_NE(figure.script.find("set size ratio -1"), std::string::npos);
  EXPECT_NE(figure.script.find("set xlabel 'x (m)'"), std::string::npos);
  EXPECT_NE(figure.script.find("set ylabel 'z (m)'"), std::string::npos);
  EXPECT_NE(figure.script.find("index 1 using 2:4"), std::string::npos);
  EXPECT_EQ(AxesFigure("t", evaluation, evaluation.alignments[0], {}).data, figure.data);
}

TEST_F(FiguresTest, ErrorsAreSignedAndInterruptedAtGaps) {
  const auto evaluation = SampleEvaluation();
  for (const ErrorAxis axis : {ErrorAxis::kTime, ErrorAxis::kDistance}) {
    const auto blocks = Blocks(ErrorFigure("e", evaluation, evaluation.alignments[0], axis, {}).data);
    ASSERT_EQ(blocks.size(), 2u);
    EXPECT_EQ(blocks[1].front(), "5 50 -1 0 1 0");
    EXPECT_EQ(blocks[1].back(), "10 100 -2 0 2 0");
  }
}

TEST_F(FiguresTest, ErrorsAreOverTimeOrDistance) {
  const auto evaluation = SampleEvaluation();
  const auto& result = evaluation.alignments[0];
  const std::string time = ErrorFigure("e", evaluation, result, ErrorAxis::kTime, {}).script;
  const std::string distance = ErrorFigure("e", evaluation, result, ErrorAxis::kDistance, {}).script;
  EXPECT_NE(time.find("using 1:3 "), std::string::npos) << time;
  EXPECT_NE(time.find("set xrange [0:10]"), std::string::npos) << time;
  EXPECT_NE(time.find("set xlabel 'time (s)'"), std::string::npos) << time;
  EXPECT_NE(distance.find("using 2:3 "), std::string::npos) << distance;
  EXPECT_NE(distance.find("set xrange [0:100]"), std::string::npos) << distance;
  EXPECT_NE(distance.find("set xlabel 'distance travelled (m)'"), std::string::npos) << distance;
  auto without_stamps = evaluation;
  without_stamps.has_stamps = false;
  const std::string frames = AxesFigure("e", without_stamps, result, {}).script;
  EXPECT_NE(frames.find("set xlabel 'frame (number)'"), std::string::npos) << frames;
}

TEST_F(FiguresTest, GapsAreShadedAndReinitialisationsMarked) {
  const auto evaluation = SampleEvaluation();
  const auto& result = evaluation.alignments[0];
  const std::vector<TimeNs> reinitialisations{5 * kNsPerSecond};
  const std::string time = ErrorFigure("e", evaluation, result, ErrorAxis::kTime, reinitialisations).script;
  EXPECT_NE(time.find("set object rectangle from 4, graph 0 to 5, graph 1"), std::string::npos) << time;
  EXPECT_NE(time.find("set arrow from 5, graph 0 to 5, graph 1"), std::string::npos) << time;
  EXPECT_NE(time.find("'no pose'"), std::string::npos) << time;
  EXPECT_NE(time.find("'reinitialised'"), std::string::npos) << time;
  const std::string distance = ErrorFigure("e", evaluation, result, ErrorAxis::kDistance, reinitialisations).script;
  EXPECT_NE(distance.find("set object rectangle from 40, graph 0 to 50, graph 1"), std::string::npos) << distance;
  EXPECT_NE(distance.find("set arrow from 50, graph 0 to 50, graph 1"), std::string::npos) << distance;
}

TEST_F(FiguresTest, MissingEndsOfTheEstimateAreShaded) {
  geometry::Trajectory truth;
  for (int i = 0; i <= 100; ++i)
    truth.push_back({i * (kNsPerSecond / 10), geometry::SE3({1, 0, 0, 0}, {0, 0, 1.0 * i})});
  const geometry::Trajectory estimate(truth.begin() + 20, truth.begin() + 60);
  const auto evaluation =
      evaluation::Evaluate(truth, estimate, evaluation::ParseAlignments("none"), {}, evaluation::EvaluationOptions());
  const auto& result = evaluation.alignments[0];
  for (const std::string& script : {ErrorFigure("e", evaluation, result, ErrorAxis::kTime, {}).script,
                                    AxesFigure("e", evaluation, result, {}).script}) {
    EXPECT_NE(script.find("set xrange [0:10]"), std::string::npos) << script;
    EXPECT_NE(script.find("set object rectangle from 0, graph 0 to 2, graph 1"), std::string::npos) << script;
    EXPECT_NE(script.find("set object rectangle from 5.9, graph 0 to 10, graph 1"), std::string::npos) << script;
  }
  const std::string distance = ErrorFigure("e", evaluation, result, ErrorAxis::kDistance, {}).script;
  EXPECT_EQ(distance.find("set object"), std::string::npos) << distance;
}

TEST_F(FiguresTest, ScaleDriftIsInterruptedWhereUndetermined) {
  auto evaluation = SampleEvaluation();
  evaluation.alignments[0].segments.local_scale = {
      {0.0, 0.0, 1.25}, {0.4, 4.0, NAN}, {0.8, 8.0, NAN}, {1.0, 10.0, 0.75}, {1.5, 15.0, 1.0}};
  const Figure figure = ScaleDriftFigure("s", evaluation, evaluation.alignments[0], {});
  const auto blocks = Blocks(figure.data);
  ASSERT_EQ(blocks.size(), 2u);
  EXPECT_EQ(blocks[0], std::vector<std::string>{"0 0 1.25"});
  EXPECT_EQ(blocks[1], (std::vector<std::string>{"1 10 0.75", "1.5 15 1"}));
}

TEST_F(FiguresTest, LiveFeaturesCountEveryFrame) {
  const std::vector<LiveFeatures> frames{
      {kNsPerSecond, 2}, {2 * kNsPerSecond, 1}, {3 * kNsPerSecond, 0}, {4 * kNsPerSecond, 1}};
  const Figure figure = LiveFeaturesFigure("f", frames);
  EXPECT_EQ(figure.data, "# seconds since the first frame, live features\n0 2\n1 1\n2 0\n3 1\n");
  EXPECT_NE(figure.script.find("'mean 1.0'"), std::string::npos) << figure.script;
}

TEST_F(FiguresTest, SinglePosesBetweenGapsAreVisible) {
  if (!HaveGnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  geometry::Trajectory truth;
  geometry::Trajectory estimate;
  for (int i = 0; i <= 400; ++i) {
    truth.push_back({i * (kNsPerSecond / 10), geometry::SE3({1, 0, 0, 0}, {0, 0, 1.0 * i})});
    if (i <= 100 || i == 200 || i >= 300) estimate.push_back(truth.back());
  }
  const auto evaluation =
      evaluation::Evaluate(truth, estimate, evaluation::ParseAlignments("none"), {}, evaluation::EvaluationOptions());
  const auto& result = evaluation.alignments[0];
  const auto dots = [&](const std::string& name, const Figure& figure) {
    Gnuplot(folder).Draw(name, figure);
    const std::string svg = ReadFile(folder / (name + ".svg"));
    int count = 0;
    for (auto at = svg.find("<use xlink:href='#gpPt6' transform"); at != std::string::npos;
         at = svg.find("<use xlink:href='#gpPt6' transform", at + 1)) {
      ++count;
    }
    return count;
  };
  // At the beginning of each of the three stretches of the estimate; the truth has one; each start is marked again.
  EXPECT_EQ(dots("e", ErrorFigure("e", evaluation, result, ErrorAxis::kTime, {})), 4 * 3);
  EXPECT_EQ(dots("d", ErrorFigure("d", evaluation, result, ErrorAxis::kDistance, {})), 4 * 3);
  EXPECT_EQ(dots("t", TrajectoryFigure("t", evaluation, result)), 1 + 3 + 2);  // and in the legend
  EXPECT_EQ(dots("a", AxesFigure("a", evaluation, result, {})), 3 * (1 + 3));
}

TEST_F(FiguresTest, LongCurvesAreThinnedInTheFigureOnly) {
  geometry::Trajectory truth;
  for (TimeNs i = 0; i < 12'000; ++i)
    truth.push_back({i * 10'000'000, geometry::SE3({1, 0, 0, 0}, {0, 0, 0.1 * static_cast<double>(i)})});
  const auto evaluation =
      evaluation::Evaluate(truth, truth, evaluation::ParseAlignments("none"), {}, evaluation::EvaluationOptions());
  const Figure figure = ErrorFigure("e", evaluation, evaluation.alignments[0], ErrorAxis::kTime, {});
  EXPECT_EQ(Blocks(figure.data)[0].size(), 12'000u);
  EXPECT_NE(figure.script.find("data every 3 using"), std::string::npos) << figure.script;
}

/// All figures of one evaluation and of its tracks; true if gnuplot drew every one of them without a word.
bool DrawsAll(const fs::path& folder, const evaluation::Evaluation& evaluation,
              std::span<const TimeNs> reinitialisations, const evaluation::LifetimeStatistics& lifetimes,
              std::span<const LiveFeatures> live) {
  const auto& result = evaluation.alignments[0];
  const std::vector<std::pair<std::string, Figure>> figures{
      {"trajectory", TrajectoryFigure("trajectory", evaluation, result)},
      {"axes", AxesFigure("axes", evaluation, result, reinitialisations)},
      {"errors", ErrorFigure("errors", evaluation, result, ErrorAxis::kTime, reinitialisations)},
      {"errors_distance", ErrorFigure("errors_distance", evaluation, result, ErrorAxis::kDistance, reinitialisations)},
      {"scale", ScaleDriftFigure("scale", evaluation, result, reinitialisations)},
      {"lifetime", LifetimeFigure("lifetime", lifetimes)},
      {"lifetime_seconds", LifetimeSecondsFigure("lifetime_seconds", lifetimes)},
      {"live_features", LiveFeaturesFigure("live_features", live)}};
  bool all = true;
  for (const auto& [name, figure] : figures) {
    Gnuplot(folder).Draw(name, figure);
    for (const char* ending : {".svg", ".pdf"}) {
      if (fs::exists(folder / (name + ending))) continue;
      ADD_FAILURE() << folder / (name + ending) << " is missing\n" << figure.script;
      all = false;
    }
  }
  return all;
}

TEST_F(FiguresTest, DrawsSvgAndPdfWithTheSameBytesEachTime) {
  if (!HaveGnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  evaluation::LifetimeStatistics lifetimes;
  lifetimes.histogram = {{3, 5, 4}, {5, 7, 1}};
  lifetimes.histogram_seconds = {{0.0, 0.05, 4}, {0.05, 0.1, 1}};
  const std::vector<TimeNs> reinitialisations{5 * kNsPerSecond, 7 * kNsPerSecond};
  const std::vector<LiveFeatures> live{{reinitialisations[0], 1}, {reinitialisations[1], 0}};
  for (const char* run : {"a", "b"}) {
    ASSERT_TRUE(DrawsAll(folder / run, SampleEvaluation(), reinitialisations, lifetimes, live));
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "a"), {}), 8 * 4);
  for (const auto& entry : fs::directory_iterator(folder / "a")) {
    const fs::path name = entry.path().filename();
    const std::string bytes = ReadFile(entry.path());
    EXPECT_EQ(bytes, ReadFile(folder / "b" / name)) << name;
    EXPECT_EQ(name.extension() == ".svg", bytes.find("</svg>") != std::string::npos) << name;
    EXPECT_EQ(name.extension() == ".pdf", bytes.starts_with("%PDF")) << name;
  }
}

/// `count` poses from `offset` on, 0.1 s and `step` apart, each off by `error` m to the right.
evaluation::Evaluation EvaluateLine(int count, double step, double error, double offset = 0.0) {
  geometry::Trajectory truth;
  geometry::Trajectory estimate;
  for (int i = 0; i < count; ++i) {
    const TimeNs t = i * (kNsPerSecond / 10);
    truth.push_back({t, geometry::SE3({1, 0, 0, 0}, {offset, offset, offset + step * i})});
    estimate.push_back({t, geometry::SE3({1, 0, 0, 0}, {offset + error * i, offset, offset + step * i})});
  }
  return evaluation::Evaluate(truth, estimate, evaluation::ParseAlignments("none"), {},
                              evaluation::EvaluationOptions());
}

TEST_F(FiguresTest, DrawsDegenerateAndExtremeData) {
  if (!HaveGnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const std::pair<const char*, evaluation::Evaluation> cases[] = {
      {"one pose", EvaluateLine(1, 0.0, 0.0)},         {"two poses", EvaluateLine(2, 1.0, 0.0)},
      {"standstill", EvaluateLine(50, 0.0, 0.0)},      {"straight line", EvaluateLine(50, 1.0, 0.0)},
      {"tiny errors", EvaluateLine(50, 1.0, 1e-9)},    {"huge errors", EvaluateLine(50, 1.0, 1e5)},
      {"absurd errors", EvaluateLine(50, 1e30, 1e60)}, {"far away", EvaluateLine(50, 1e-3, 1e-4, 1e7)}};
  for (const auto& [name, evaluation] : cases) {
    SCOPED_TRACE(name);
    EXPECT_TRUE(DrawsAll(folder / name, evaluation, {}, {}, {}));
  }
}

TEST_F(FiguresTest, MissingGnuplotLeavesDataAndScript) {
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", folder.c_str(), 1);
  Gnuplot gnuplot(folder / "plots");
  evaluation::LifetimeStatistics statistics;
  statistics.histogram = {{3, 4, 1}};
  gnuplot.Draw("lifetime", LifetimeFigure("lifetime", statistics));
  gnuplot.Draw("again", LifetimeFigure("again", statistics));
  ::setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(ReadFile(folder / "plots" / "lifetime.dat"),
            "# lifetime from (frames), to below (frames), tracks\n3 4 1\n");
  EXPECT_TRUE(fs::exists(folder / "plots" / "again.gp"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "plots"), {}), 4);
}

}  // namespace
}  // namespace evo::report
