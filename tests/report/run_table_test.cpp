#include "evo/report/run_table.hpp"

#include "report/run_fixtures.hpp"
#include "report/tables/latex.hpp"

namespace evo::report {
namespace {

using RunTableTest = RunsTest;

TEST_F(RunTableTest, HasOneRowForEachRunAndAlignment) {
  const auto runs = ReadRunFolders({EvaluatedRun("day"), FailedRun("bad", "exit code 4: gone"), TrackedRun("tracks")});
  const auto table = MergeRuns(runs);
  EXPECT_EQ(table.columns,
            (std::vector<std::string>{"run", "status", "failure", "sequence", "alignment", "coverage", "mean_planar_m",
                                      "lifetime_mean_frames", "lifetime_std_frames", "lifetime_mean_s",
                                      "lifetime_std_s", "lifetime_tracks", "recorded_s", "speed_x_real_time", "threads",
                                      "wall_track_s", "wall_odometry_s", "parameters"}));
  ASSERT_EQ(table.rows.size(), 4u);
  for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.columns.size());
  EXPECT_EQ(Cell(table, 0, "alignment"), "origin-scale");
  EXPECT_EQ(Cell(table, 1, "run"), "day");
  EXPECT_EQ(Cell(table, 1, "status"), "ok");
  EXPECT_EQ(Cell(table, 1, "mean_planar_m"), "0.5");
  EXPECT_EQ(Cell(table, 1, "speed_x_real_time"), "2.5");
  EXPECT_EQ(Cell(table, 1, "threads"), "2");
  EXPECT_EQ(Cell(table, 2, "status"), "failed");
  EXPECT_EQ(Cell(table, 2, "failure"), "exit code 4: gone");
  EXPECT_EQ(Cell(table, 2, "mean_planar_m"), "");
  EXPECT_EQ(Cell(table, 3, "lifetime_mean_frames"), "4.000000000");
  EXPECT_EQ(Cell(table, 3, "lifetime_std_s"), "0.025000000");
  EXPECT_EQ(Cell(table, 3, "lifetime_tracks"), "2");
}

TEST_F(RunTableTest, MergesTheColumnsOfAllSummaries) {
  const auto runs = ReadRunFolders({EvaluatedRun("old", {}, "sequence,alignment,coverage\nday,sim3,1\n"),
                                    EvaluatedRun("new", {}, "sequence,alignment,added,coverage\nday,sim3,7,0.5\n")});
  const auto table = MergeRuns(runs);
  EXPECT_LT(*table.Find("coverage"), *table.Find("added"));
  EXPECT_EQ(Cell(table, 0, "added"), "");
  EXPECT_EQ(Cell(table, 1, "added"), "7");
  EXPECT_EQ(Cell(table, 1, "coverage"), "0.5");
}

TEST_F(RunTableTest, NamesOnlyParametersThatDiffer) {
  const auto runs =
      ReadRunFolders({EvaluatedRun("a", {{"x.one", "1"}, {"x.two", "2"}, {"x.three", "3"}}), FailedRun("b", "gone"),
                      EvaluatedRun("c", {{"x.one", "1"}, {"x.two", "5"}, {"x.new", "n"}})});
  const auto differences = CompareParameters(runs);
  ASSERT_EQ(differences.size(), 3u);
  EXPECT_EQ(differences[0].name, "x.two");
  EXPECT_EQ(differences[0].values, (std::vector<std::string>{"2", "", "5"}));
  EXPECT_EQ(differences[1].name, "x.three");
  EXPECT_EQ(differences[2].name, "x.new");
  const auto table = MergeRuns(runs);
  EXPECT_EQ(Cell(table, 0, "parameters"), "x.two=2 x.three=3");
  EXPECT_EQ(Cell(table, 2, "parameters"), "");
  EXPECT_EQ(Cell(table, 3, "parameters"), "x.two=5 x.new=n");
}

TEST_F(RunTableTest, EqualRunsHaveNoDifferences) {
  const auto runs = ReadRunFolders({EvaluatedRun("a", {{"x", "1"}}), EvaluatedRun("b", {{"x", "1"}})});
  EXPECT_TRUE(CompareParameters(runs).empty());
}

TEST_F(RunTableTest, ChoosesTheFirstCommonAlignment) {
  const auto both = EvaluatedRun("both");
  const auto only = EvaluatedRun("only", {}, "sequence,alignment\nday,sim3\n");
  const auto other = EvaluatedRun("other", {}, "sequence,alignment\nday,none\n");
  const auto bad = FailedRun("bad", "gone");
  EXPECT_EQ(ChooseAlignment(ReadRunFolders({both}), ""), "origin-scale");
  EXPECT_EQ(ChooseAlignment(ReadRunFolders({both, bad, only}), ""), "sim3");
  EXPECT_EQ(ChooseAlignment(ReadRunFolders({both, other}), ""), "origin-scale");
  EXPECT_EQ(ChooseAlignment(ReadRunFolders({both, other}), "none"), "none");
  EXPECT_EQ(ChooseAlignment(ReadRunFolders({bad}), ""), "");
  try {
    ChooseAlignment(ReadRunFolders({both}), "se3");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kUsage);
  }
}

TEST_F(RunTableTest, LatexHasOneRowARun) {
  const auto runs = ReadRunFolders({EvaluatedRun("day_1"), FailedRun("b&d", "a/b_c is 100% gone"), TrackedRun("tracks"),
                                    EvaluatedRun("other", {}, "sequence,alignment\nday,none\n")});
  const std::string latex = RunsLatex(MergeRuns(runs), "sim3");
  EXPECT_NE(latex.find("\nday\\_1 & -- & 90.0 & -- & -- & 0.5000 & -- & -- & -- & -- & 2.50 \\\\\n"), std::string::npos)
      << latex;
  EXPECT_NE(latex.find("\nb\\&d & \\multicolumn{10}{p{0.6\\linewidth}}{\\raggedright failed: "
                       "a/\\allowbreak{}b\\_c is 100\\% gone} \\\\\n"),
            std::string::npos)
      << latex;
  EXPECT_NE(latex.find("\ntracks & -- & -- & -- & -- & -- & -- & -- & -- & 4.0 & 2.50 \\\\\n"), std::string::npos)
      << latex;
  EXPECT_NE(latex.find("\nother & \\multicolumn{10}{p{0.6\\linewidth}}{\\raggedright no alignment sim3} \\\\\n"),
            std::string::npos)
      << latex;
  EXPECT_NE(latex.find("\\toprule\n"), std::string::npos);
  EXPECT_TRUE(latex.ends_with("\\bottomrule\n\\end{tabular}\n"));
}

TEST(Latex, EscapesSpecialCharacters) {
  EXPECT_EQ(LatexEscape("a_b & 5% of $x {y} #1"), "a\\_b \\& 5\\% of \\$x \\{y\\} \\#1");
  EXPECT_EQ(LatexEscape("~^\\<>|"),
            "\\textasciitilde{}\\textasciicircum{}\\textbackslash{}\\textless{}\\textgreater{}\\textbar{}");
}

}  // namespace
}  // namespace evo::report
