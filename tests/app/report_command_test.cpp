// evo-run report: what it writes and what it refuses.
#include "app/evo_run.hpp"

namespace evo::app {
namespace {

namespace fs = std::filesystem;

class ReportCommandTest : public EvoRunTest {
 protected:
  /// The output folder of a run.
  std::string Evaluated(const std::string& name) {
    const std::string data = std::string(EVO_SOURCE_DIR) + "/tests/evaluation/data/";
    EXPECT_EQ(Run("evaluate --no-plots --estimate " + Quote(data + "est_drift.txt") + " --ground-truth " +
                  Quote(data + "gt.txt") + " --out " + Quote(Path(name))),
              0)
        << err;
    return Quote(Path(name)) + " ";
  }

  std::string To(const std::string& name) const { return "--out " + Quote(Path(name)); }
};

TEST_F(ReportCommandTest, MergesRuns) {
  const std::string runs = Evaluated("a") + Evaluated("<b>");
  fs::create_directory(folder / "bad");
  Write("bad/failure.txt", "exit code 4: cut short\n");
  ASSERT_EQ(Run("report " + runs + Quote(Path("bad")) + " --title 'My runs' " + To("report")), 0) << err;
  EXPECT_TRUE(out.starts_with("runs       3, of which 1 failed\n")) << out;
  const std::string csv = ReadFile(folder / "report" / "runs.csv");
  EXPECT_EQ(std::ranges::count(csv, '\n'), 6) << csv;
  EXPECT_NE(csv.find("\n<b>,ok,,gt,sim3,"), std::string::npos) << csv;
  EXPECT_NE(csv.find("\nbad,failed,exit code 4: cut short,"), std::string::npos) << csv;
  EXPECT_NE(ReadFile(folder / "report" / "runs.tex").find("alignment origin-scale"), std::string::npos);
  EXPECT_NE(ReadFile(folder / "report" / "index.html").find("<h1>My runs</h1>"), std::string::npos);
  EXPECT_EQ(CountFiles(folder / "report"), 3);
}

TEST_F(ReportCommandTest, EarlierReportsAreKeptUnlessForced) {
  const std::string run = Evaluated("a");
  ASSERT_EQ(Run("report " + run + To("report")), 0) << err;
  const std::string page = ReadFile(folder / "report" / "index.html");
  EXPECT_EQ(Refusal("report " + run + "--alignment sim3 " + To("report")), 8);
  EXPECT_EQ(Run("report --force " + run + "--alignment sim3 " + To("report")), 0) << err;
  EXPECT_EQ(ReadFile(folder / "report" / "index.html"), page);
  EXPECT_NE(ReadFile(folder / "report" / "runs.tex").find("alignment sim3"), std::string::npos);
}

TEST_F(ReportCommandTest, ErrorsHaveTheirExitCodes) {
  const std::string run = Evaluated("a");
  EXPECT_EQ(Refusal("report " + To("report")), 2);
  EXPECT_EQ(Refusal("report " + run), 2);
  EXPECT_EQ(Refusal("report " + run + "--alignment se3 " + To("report")), 2);
  EXPECT_EQ(Refusal("report " + run + Quote(Path("absent")) + " " + To("report")), 4);
  EXPECT_EQ(Refusal("report " + Quote(Sample()) + " " + To("report")), 4);
  const std::string summary = ReadFile(folder / "a" / "summary.csv");
  Write("a/summary.csv", summary.substr(0, summary.size() - 20));
  EXPECT_EQ(Refusal("report " + run + To("report")), 4);
  EXPECT_NE(err.find("summary.csv:3"), std::string::npos) << err;
  EXPECT_FALSE(fs::exists(folder / "report"));
}

}  // namespace
}  // namespace evo::app
