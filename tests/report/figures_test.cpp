#include "evo/report/figures.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>

#include "fixtures.hpp"

namespace evo {
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

TEST_F(FiguresTest, TrajectoryIsSeenFromAboveAndBrokenAtGaps) {
  const auto evaluation = SampleEvaluation();  // MVSEC axes: right is x, away is z
  const Figure figure = TrajectoryFigure("t", evaluation, evaluation.alignments[0]);
  const auto blocks = Blocks(figure.data);
  ASSERT_EQ(blocks.size(), 3u);  // truth, estimate before and after its gap
  EXPECT_EQ(blocks[0].size(), 201u);
  EXPECT_EQ(blocks[1].size(), 81u);
  EXPECT_EQ(blocks[2].size(), 101u);
  EXPECT_EQ(blocks[2].back(), "10.000000 0.000000 98.000000");
  EXPECT_NE(figure.script.find("set size ratio -1"), std::string::npos);
  EXPECT_NE(figure.script.find("set xlabel 'x (m)'"), std::string::npos);
  EXPECT_NE(figure.script.find("set ylabel 'z (m)'"), std::string::npos);
}

TEST_F(FiguresTest, ErrorsAreSignedAndBrokenAtGaps) {
  const auto evaluation = SampleEvaluation();
  const auto blocks = Blocks(ErrorFigure("e", evaluation, evaluation.alignments[0]).data);
  ASSERT_EQ(blocks.size(), 2u);
  EXPECT_EQ(blocks[1].back(), "10.000000 -2.000000 0.000000 2.000000");
}

TEST_F(FiguresTest, DrawsSvgAndPdfWithTheSameBytesEachTime) {
  if (!HaveGnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const auto evaluation = SampleEvaluation();
  const auto& result = evaluation.alignments[0];
  for (const char* run : {"a", "b"}) {
    Gnuplot gnuplot(folder / run);
    gnuplot.Draw("trajectory", TrajectoryFigure("trajectory", evaluation, result));
    gnuplot.Draw("errors", ErrorFigure("errors", evaluation, result));
    gnuplot.Draw("lifetime", LifetimeFigure("lifetime", {}));
  }
  for (const char* name : {"trajectory", "errors", "lifetime"}) {
    for (const char* ending : {".svg", ".pdf", ".dat", ".gp"}) {
      const std::string file = std::string(name) + ending;
      EXPECT_EQ(ReadFile(folder / "a" / file), ReadFile(folder / "b" / file)) << file;
    }
    EXPECT_NE(ReadFile(folder / "a" / (std::string(name) + ".svg")).find("</svg>"), std::string::npos);
    EXPECT_TRUE(ReadFile(folder / "a" / (std::string(name) + ".pdf")).starts_with("%PDF"));
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "a"), {}), 12);
}

TEST_F(FiguresTest, MissingGnuplotLeavesDataAndScript) {
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", folder.c_str(), 1);
  Gnuplot gnuplot(folder / "plots");
  LifetimeStatistics statistics;
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
}  // namespace evo
