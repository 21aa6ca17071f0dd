#include "evo/report/run_page.hpp"

#include "report/run_fixtures.hpp"

namespace evo::report {
namespace {

class RunPageTest : public RunsTest {
 protected:
  static std::string Page(const std::vector<std::filesystem::path>& paths, const std::string& title = "Runs") {
    const auto runs = ReadRunFolders(paths);
    return RunsPage(title, runs, MergeRuns(runs));
  }

  static int Count(const std::string& page, const std::string& text) {
    int count = 0;
    for (auto at = page.find(text); at != std::string::npos; at = page.find(text, at + 1)) ++count;
    return count;
  }
};

TEST_F(RunPageTest, EscapesNames) {
  const auto run = EvaluatedRun("<b>\"x' & {{script}}", {{"p", "</script>"}});
  const std::string page = Page({run, EvaluatedRun("y", {{"p", "1"}}), FailedRun("<i>", "</td><img src=x>")}, "<u>");
  for (const char* raw : {"<b>", "<i>", "<u>", "<img src=x>"}) EXPECT_EQ(Count(page, raw), 0) << raw;
  EXPECT_EQ(Count(page, "</script>"), 1);
  EXPECT_EQ(Count(page, "\"use strict\""), 1);
  EXPECT_NE(page.find("<title>&lt;u&gt;</title>"), std::string::npos);
  EXPECT_NE(page.find("&lt;b&gt;&quot;x&#39; &amp; {{script}}</a>"), std::string::npos);
  EXPECT_NE(page.find("&lt;/td&gt;&lt;img src=x&gt;"), std::string::npos);
}

TEST_F(RunPageTest, IsSelfContained) {
  const auto run = EvaluatedRun("day");
  Write("day/plots/axes.svg", "<svg id=\"a\"/>");
  Write("day/images/four_frames_1.png", "png");
  const std::string page = Page({run});
  EXPECT_NE(page.find("src=\"data:image/svg+xml;base64,PHN2ZyBpZD0iYSIvPg==\""), std::string::npos);
  EXPECT_NE(page.find("src=\"data:image/png;base64,cG5n\""), std::string::npos);
  EXPECT_EQ(Count(page, "http"), 1) << "only http-equiv";
  EXPECT_EQ(Count(page, "src="), 2);
  EXPECT_EQ(Count(page, "<link"), 0);
  EXPECT_EQ(Count(page, "{{"), 0);
  EXPECT_EQ(Count(page, "class=\"thumbnails\""), 0);
}

TEST_F(RunPageTest, ShowsTrajectoryAndErrorsOfAllRunsBelowTheTable) {
  const auto day = EvaluatedRun("day");
  const auto night = EvaluatedRun("night");
  Write("day/plots/errors.svg", "<svg viewBox=\"0 0 900 620\" id=\"a\"/>");
  Write("day/plots/trajectory.svg", "<svg viewBox=\"0 0 9 0\" id=\"b\"/>");
  Write("day/plots/errors_sim3.svg", "<svg/>");
  Write("night/plots/errors.svg", "<svg/>");
  const std::string page = Page({FailedRun("bad", "gone"), day, night});
  const auto trajectory = page.find(
      "<svg viewBox=\"0 0 900 600\" role=\"img\" aria-label=\"day: trajectory\"><image id=\"picture-2-trajectory\" "
      "width=\"900\" height=\"600\" href=\"data:image/svg+xml;base64,");
  const auto errors = page.find("<image id=\"picture-2-errors\" width=\"900\" height=\"620\" ");
  EXPECT_LT(page.find("<h2>Results"), page.find("<h2>Trajectories and errors"));
  EXPECT_LT(page.find("<h2>Trajectories and errors"), trajectory);
  EXPECT_LT(trajectory, errors);
  EXPECT_LT(errors, page.find("<image id=\"picture-3-errors\""));
  EXPECT_LT(page.find("<image id=\"picture-3-errors\""), page.find("<h2>Parameters"));
  EXPECT_EQ(Count(page, "<image "), 3);
  // The details show the same without a copy.
  EXPECT_EQ(Count(page, "data:image/svg+xml"), 4);
  EXPECT_LT(page.find("id=\"run-2\""), page.find("<use href=\"#picture-2-errors\"/>"));
  EXPECT_EQ(Count(page, "<use href="), 3);
}

TEST_F(RunPageTest, ShowsFailuresFirstAndInTheTable) {
  const std::string page = Page({EvaluatedRun("day"), FailedRun("night", "exit code 6: tracking lost")});
  const auto first = page.find("exit code 6: tracking lost");
  EXPECT_LT(page.find("1 run failed"), first);
  EXPECT_LT(first, page.find("<h2>Results"));
  EXPECT_NE(page.find("colspan=\"11\">exit code 6: tracking lost</td>"), std::string::npos);
  EXPECT_EQ(Page({EvaluatedRun("day")}).find("class=\"failures\""), std::string::npos);
}

TEST_F(RunPageTest, ShowsNumbersParametersAndOrigin) {
  const std::string page = Page({EvaluatedRun("a", {{"x.y", "1"}, {"same", "0"}}), EvaluatedRun("b", {{"x.y", "2"}})});
  EXPECT_NE(page.find("<td class=\"number\" data-value=\"0.9\">90.0</td>"), std::string::npos);
  EXPECT_NE(page.find("<td class=\"number\" data-value=\"1.25\">1.2500</td>"), std::string::npos);
  EXPECT_NE(page.find("<tr><th scope=\"row\">x.y</th><td>1</td><td>2</td></tr>"), std::string::npos);
  EXPECT_NE(page.find("<pre>evo-run run &#39;it&#39;\\&#39;&#39;s&#39;</pre>"), std::string::npos);
  EXPECT_NE(page.find("odometry reinitialised at 1.500000000 s"), std::string::npos);
  EXPECT_NE(page.find("<code>abc</code>"), std::string::npos);
  EXPECT_NE(page.find("id=\"run-2\""), std::string::npos);
  EXPECT_EQ(Count(page, "href=\"#run-2\""), 4);  // two alignments in two tables
}

TEST_F(RunPageTest, ShowsWhatWasSeenAboveTheResults) {
  EXPECT_EQ(Page({EvaluatedRun("old")}).find("What was seen"), std::string::npos);
  Manifest manifest;
  manifest.seen = {{"coverage", 0.9}, {"restarts", 2.0}};
  manifest.warnings = {"only 90.0 % of the frames <have> a pose"};
  const auto day = EvaluatedRun("day");
  WriteManifest(day / "manifest.json", manifest);
  const std::string page = Page({EvaluatedRun("old"), day});
  const auto section = page.find("<h2>What was seen</h2>");
  const auto warning = page.find("day</a>: only 90.0 % of the frames &lt;have&gt; a pose</li>");
  const auto value =
      page.find("<td class=\"number\" data-value=\"0.9\">90.0</td><td class=\"number\" data-value=\"2\">2</td>");
  EXPECT_LT(section, warning);
  EXPECT_LT(warning, value);
  EXPECT_LT(value, page.find("<h2>Results"));
  manifest.warnings.clear();
  WriteManifest(day / "manifest.json", manifest);
  EXPECT_NE(Page({day}).find("Nothing is out of the ordinary."), std::string::npos);
}

TEST_F(RunPageTest, NamesTooLargePictures) {
  const auto run = EvaluatedRun("day");
  Write("day/plots/errors.svg", std::string(2'000'001, ' '));
  const std::string page = Page({run});
  EXPECT_LT(page.size(), 100'000u);
  EXPECT_NE(page.find("errors.svg (2.0 MB) is too large"), std::string::npos);
}

TEST_F(RunPageTest, EqualRunsGiveEqualBytes) {
  const auto run = EvaluatedRun("day");
  EXPECT_EQ(Page({run}), Page({run}));
}

}  // namespace
}  // namespace evo::report
