#include "evo/core/parameters.hpp"

#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>

#include "evo/core/error.hpp"

namespace evo {
namespace {

class ParametersTest : public ::testing::Test {
 protected:
  ParametersTest() {
    parameters.Add("tracker.sigma_px", &sigma, 0.1, 10.0, "smoothing (px)");
    parameters.Add("tracker.features", &features, 8, 1000, "features");
    parameters.Add("odometry.refine", &refine, "refine");
    parameters.Add("odometry.weight", &weight, {"tukey", "huber"}, "robust weight");
  }

  std::string Refusal(const std::string& yaml) {
    try {
      parameters.LoadText(yaml, "run.yaml");
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kConfiguration);
      return error.what();
    }
    ADD_FAILURE() << "accepted: " << yaml;
    return "";
  }

  Parameters parameters;
  double sigma = 2.0;
  int features = 100;
  bool refine = true;
  std::string weight = "tukey";
};

TEST_F(ParametersTest, ReadsWhatItPrints) {
  parameters.LoadText("tracker: {sigma_px: 0.3, features: 300}\nodometry:\n  refine: false\n  weight: huber\n", "a");
  EXPECT_DOUBLE_EQ(sigma, 0.3);
  const std::string printed = parameters.ToYaml();
  sigma = 1.0, features = 9, refine = true, weight = "tukey";
  parameters.LoadText(printed, "printed");
  EXPECT_DOUBLE_EQ(sigma, 0.3);
  EXPECT_EQ(features, 300);
  EXPECT_FALSE(refine);
  EXPECT_EQ(weight, "huber");
}

TEST_F(ParametersTest, ReadsBackAnyTextThatItPrints) {
  std::string text;
  Parameters texts;
  texts.Add(
      "file", &text, [](const std::string&) { return true; }, "path", "a file");
  EXPECT_NE(texts.ToYaml().find("file: \"\"  # a file"), std::string::npos) << texts.ToYaml();
  for (const std::string value : {"", "a b.txt", "a: b", "a #b", "#b", "null", "\"q\"", "52,56", "- x", " x "}) {
    text = value;
    const std::string printed = texts.ToYaml();
    text = "other";
    texts.LoadText(printed, "printed");
    EXPECT_EQ(text, value) << printed;
  }
}

TEST_F(ParametersTest, PrintsEveryKeyOnce) {
  int depth = 3;
  double share = 0.5;
  Parameters mixed;
  mixed.Add("a.b.depth", &depth, 1, 9, "of b");
  mixed.Add("a.share", &share, 0.0, 1.0, "of a");
  mixed.Add("a.b.refine", &refine, "of b");
  EXPECT_EQ(mixed.ToYaml(),
            "a:\n  share: 0.5  # of a; 0 to 1\n\n  b:\n    depth: 3  # of b; 1 to 9\n    refine: true  # of b\n");
}

TEST_F(ParametersTest, NamesTheLineAndTheNearestKey) {
  const std::string message = Refusal("tracker:\n  features: 100\n  sigma_xp: 2\n");
  EXPECT_NE(message.find("run.yaml:3"), std::string::npos) << message;
  EXPECT_NE(message.find("tracker.sigma_px"), std::string::npos) << message;
}

TEST_F(ParametersTest, RefusesValuesOutOfRangeOrOfTheWrongType) {
  for (const char* value : {"sigma_px: 0", "sigma_px: nan", "sigma_px: wide", "features: 2.5", "features: 1e9",
                            "features: [1, 2]", "features: "}) {
    Refusal("tracker:\n  " + std::string(value) + "\n");
  }
  Refusal("odometry: {refine: maybe}");
  Refusal("odometry: {weight: cauchy}");
  Refusal("odometry: {refine: [");
  Refusal("just a sentence");
  EXPECT_DOUBLE_EQ(sigma, 2.0);
  EXPECT_EQ(features, 100);
}

TEST_F(ParametersTest, ASectionOfTheCallersIsSkipped) {
  parameters.LoadText("draw: {tracker.features: 1..2}\ntracker: {features: 50}", "a", "draw");
  EXPECT_EQ(features, 50);
  EXPECT_THROW(parameters.LoadText("tracker: {draw: {features: 1}}", "a", "draw"), Error) << "at the top only";
  EXPECT_THROW(parameters.LoadText("draw: 5", "a"), Error);
}

TEST_F(ParametersTest, SettingsOverrideTheFile) {
  parameters.LoadText("tracker: {features: 50}", "a");
  parameters.Set("tracker.features=60");
  EXPECT_EQ(features, 60);
  EXPECT_THROW(parameters.Set("tracker.features"), Error);
  EXPECT_THROW(parameters.Set("tracker.feature=3"), Error);
  EXPECT_THROW(parameters.LoadFile("/nonexistent.yaml"), Error);
}

TEST_F(ParametersTest, ValidatesTexts) {
  std::string list = "1,2";
  const auto is_list = [](const std::string& text) {
    return !text.empty() && text.find_first_not_of("0123456789,") == std::string::npos;
  };
  parameters.Add("odometry.list", &list, is_list, "whole numbers", "some numbers");
  parameters.Set("odometry.list=3,4,5");
  EXPECT_EQ(list, "3,4,5");
  EXPECT_NE(Refusal("odometry: {list: x}").find("must be whole numbers"), std::string::npos);
  EXPECT_EQ(list, "3,4,5");
  EXPECT_NE(parameters.ToYaml().find("list: 3,4,5  # some numbers; whole numbers\n"), std::string::npos);
}

/// Catches the log for as long as it lives.
class LogCapture {
 public:
  LogCapture() : before_(spdlog::default_logger()) {
    spdlog::set_default_logger(
        std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_st>(text_)));
    spdlog::default_logger()->set_pattern("%l: %v");
  }
  ~LogCapture() { spdlog::set_default_logger(before_); }
  LogCapture(const LogCapture&) = delete;
  LogCapture& operator=(const LogCapture&) = delete;

  std::string text() const { return text_.str(); }

 private:
  std::shared_ptr<spdlog::logger> before_;
  std::ostringstream text_;
};

TEST_F(ParametersTest, AliasAssignsTheParameterAndWarns) {
  parameters.Alias("tracker.most_features", "tracker.features");
  const LogCapture log;
  parameters.LoadText("tracker:\n  sigma_px: 1\n  most_features: 50\n", "run.yaml");
  EXPECT_EQ(features, 50);
  EXPECT_EQ(log.text(), "warning: run.yaml:3: parameter 'tracker.most_features' is now called 'tracker.features'\n");
  parameters.Set("tracker.most_features=60");
  EXPECT_EQ(features, 60);
  EXPECT_NE(log.text().find("--set tracker.most_features=60: parameter"), std::string::npos) << log.text();
  parameters.Set("tracker.features=70");
  EXPECT_EQ(std::ranges::count(log.text(), '\n'), 2) << log.text();
}

TEST_F(ParametersTest, AliasAndNameInOneFileAreGivenTwice) {
  parameters.Alias("tracker.most_features", "tracker.features");
  const LogCapture log;
  for (const char* yaml : {"tracker: {features: 50, most_features: 50}", "tracker: {most_features: 50, features: 50}",
                           "tracker: {features: 50, features: 50}"}) {
    EXPECT_NE(Refusal(yaml).find("'tracker.features' comes twice"), std::string::npos) << yaml;
  }
}

TEST_F(ParametersTest, AliasStaysOutOfSuggestionsAndOfTheYaml) {
  parameters.Alias("tracker.most_features", "tracker.features");
  EXPECT_EQ(Refusal("tracker: {most_feature: 5}").find("most_features'"), std::string::npos);
  EXPECT_EQ(parameters.ToYaml().find("most_features"), std::string::npos);
  const LogCapture log;
  EXPECT_NE(Refusal("tracker: {most_features: 5}").find("'tracker.features' is '5'"), std::string::npos);
}

TEST_F(ParametersTest, AliasOfAnUnknownParameterThrows) {
  EXPECT_THROW(parameters.Alias("tracker.most", "tracker.feature"), std::logic_error);
}

TEST_F(ParametersTest, MarkdownHasATablePerGroup) {
  std::string text;
  Parameters mixed;
  mixed.Add("b.sigma_px", &sigma, 0.1, 10.0, "smoothing (px)");
  mixed.Add("b.c.refine", &refine, "a|b (rise over run)");
  mixed.Add("b.weight", &weight, {"tukey", "huber"}, "robust weight");
  mixed.Add(
      "a.file", &text, [](const std::string&) { return true; }, "path", "trajectory");
  mixed.Alias("b.width_px", "b.sigma_px");
  EXPECT_EQ(mixed.ToMarkdown(),
            "### a\n\n| Name | Default | Unit | Values | Meaning |\n|---|---|---|---|---|\n"
            "| `a.file` | `\"\"` |  | path | trajectory |\n"
            "\n### b\n\n| Name | Default | Unit | Values | Meaning |\n|---|---|---|---|---|\n"
            "| `b.sigma_px` | `2` | px | 0.1 to 10 | smoothing; formerly `b.width_px` |\n"
            "| `b.weight` | `tukey` |  | tukey, huber | robust weight |\n"
            "\n### b.c\n\n| Name | Default | Unit | Values | Meaning |\n|---|---|---|---|---|\n"
            "| `b.c.refine` | `true` |  | true, false | a\\|b (rise over run) |\n");
}

TEST_F(ParametersTest, EmptyFileChangesNothing) {
  parameters.LoadText("", "empty");
  parameters.LoadText("# nothing\n", "comment");
  EXPECT_EQ(features, 100);
}

}  // namespace
}  // namespace evo
