#include "evo/report/latex_tables.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "evo/core/error.hpp"
#include "evo/core/output_file.hpp"
#include "report/fixtures.hpp"

namespace evo::report {
namespace {

using LatexTablesTest = ReportTest;

TEST_F(LatexTablesTest, LifetimesAsInThePapersTable2) {
  evaluation::LifetimeStatistics statistics;
  statistics.frames = 480;
  statistics.frame_interval_s = 0.025;
  statistics.tracks = 1234;
  statistics.in_frames = {16.488, 18.5051, 9.0, 100.0};
  statistics.in_seconds = {0.38725, 0.46263, 0.2, 2.5};
  EXPECT_EQ(LifetimeTable("outdoor_day2", statistics), R"(% needs \usepackage{booktabs}
\begin{table}
  \centering
  \caption{Lifetime of the feature tracks of outdoor\_day2: 1234 tracks in 480 event frames at 40.0\,Hz; tracks of fewer than 3 frames are left out.}
  \label{tab:lifetime-outdoor-day2}
  \begin{tabular}{lr}
    \toprule
    Item & Value \\
    \midrule
    Average lifetime (frames) & $16.488$ \\
    Standard deviation (frames) & $18.505$ \\
    Average lifetime (s) & $0.387$ \\
    Standard deviation (s) & $0.463$ \\
    \bottomrule
  \end{tabular}
\end{table}
)");
}

TEST_F(LatexTablesTest, ErrorsAsInThePapersTable3) {
  auto evaluation = SampleEvaluation();
  evaluation.alignments.resize(1);
  evaluation.alignments[0].lateral = {0.25, 0.5, 1.0, -1e-9, 0.004};
  EXPECT_EQ(ErrorTable("a & b", evaluation), R"(% needs \usepackage{booktabs}
\begin{table}
  \centering
  \caption{Position error of the estimate for a \& b: a path of 100.0\,m in 10.0\,s, coverage 90.0\,\%.}
  \label{tab:errors-a---b}
  \begin{tabular}{lrrr}
    \toprule
    Item & Longitudinal & Lateral & Planar \\
    \midrule
    \multicolumn{4}{l}{Alignment none, scale 1.00000, 182 poses} \\
    Average error, mean absolute (m) & $1.0104$ & $0.2500$ & $1.0104$ \\
    Relative error, largest/path (\%) & $2.0000$ & $1.0000$ & $2.0000$ \\
    Average error/path (\%) & $1.0104$ & $0.2500$ & $1.0104$ \\
    Mean of error/distance travelled (\%) & $2.0000$ & $0.4000$ & $2.0000$ \\
    Root mean square error (m) & $1.1795$ & $0.5000$ & $1.1795$ \\
    Largest error (m) & $2.0000$ & $1.0000$ & $2.0000$ \\
    Final error, signed (m) & $-2.0000$ & $0.0000$ & $2.0000$ \\
    \bottomrule
  \end{tabular}
\end{table}
)");
}

TEST_F(LatexTablesTest, EachAlignmentHasABlock) {
  const std::string table = ErrorTable("x", SampleEvaluation());
  EXPECT_NE(table.find("{Alignment none, "), std::string::npos);
  EXPECT_NE(table.find("{Alignment origin, "), std::string::npos);
}

TEST_F(LatexTablesTest, UndeterminedValuesAreDashes) {
  geometry::Trajectory still;
  for (int i = 0; i < 5; ++i) still.push_back({i * kNsPerSecond / 10, geometry::SE3()});
  const std::string table = ErrorTable("still", evaluation::Evaluate(still, still, evaluation::ParseAlignments("none"),
                                                                     {}, evaluation::EvaluationOptions()));
  EXPECT_NE(table.find("Relative error, largest/path (\\%) & -- & -- & -- \\\\"), std::string::npos) << table;
  EXPECT_NE(table.find("Mean of error/distance travelled (\\%) & -- & -- & -- \\\\"), std::string::npos) << table;
  EXPECT_EQ(table.find("nan"), std::string::npos) << table;
  const std::string lifetimes = LifetimeTable("none", {});
  EXPECT_NE(lifetimes.find("0 tracks in 0 event frames at --\\,Hz"), std::string::npos) << lifetimes;
}

TEST_F(LatexTablesTest, LatexTypesetsThem) {
  if (std::system("command -v pdflatex >/dev/null 2>&1 && kpsewhich booktabs.sty >/dev/null 2>&1") != 0) {
    GTEST_SKIP() << "pdflatex with booktabs is not installed";
  }
  const std::string name = R"(all # $ % & _ { } ~ ^ \ < > | of them)";
  WriteText(folder / "tables" / "errors.tex", ErrorTable(name, SampleEvaluation()));
  WriteText(folder / "tables" / "lifetime.tex", LifetimeTable(name, {}));
  WriteText(folder / "document.tex",
            "\\documentclass{article}\n\\usepackage{booktabs}\n\\begin{document}\n\\input{tables/lifetime}\n"
            "\\input{tables/errors}\n\\end{document}\n");
  const std::string command =
      "cd '" + folder.string() + "' && pdflatex -interaction=nonstopmode -halt-on-error document.tex >log 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << ReadFile(folder / "log");
  EXPECT_TRUE(std::filesystem::exists(folder / "document.pdf"));
}

TEST_F(LatexTablesTest, CannotWriteIsAnOutputError) {
  std::ofstream(folder / "file") << "x";
  EXPECT_THROW(WriteText(folder / "file" / "errors.tex", ""), Error);
}

}  // namespace
}  // namespace evo::report
