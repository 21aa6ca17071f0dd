#include "evo/report/run_diagnosis.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace evo::report {
namespace {

/// A drive with nothing out of the ordinary.
RunDiagnosis GoodRun() {
  RunDiagnosis run;
  run.filters = FilterDiagnosis{40, 0.0009, 0.02, 0.2, 0.1, 100.0, 0.1};
  FeatureDiagnosis features;
  features.wanted = 150;
  features.median = 148.0;
  features.min = 96;
  features.min_at = 2'100'000'000;
  features.at_rest = {10000, 0.3, 0.01};
  run.features = features;
  TrajectoryDiagnosis trajectory;
  trajectory.coverage = 0.995;
  trajectory.scale_is_held = true;
  trajectory.scale_covered_ratio = 0.9;
  trajectory.forward_ratio = 0.99;
  trajectory.duration_s = 60.0;
  trajectory.position_sigma_ratio = 0.002;
  run.trajectory = trajectory;
  return run;
}

/// The only warning of a good run after `change`.
template <typename Change>
std::string WarningAfter(const Change& change) {
  RunDiagnosis run = GoodRun();
  change(&run);
  const auto warnings = DiagnosisWarnings(run);
  EXPECT_EQ(warnings.size(), 1u) << FormatWarnings(run);
  return warnings.empty() ? "" : warnings.front();
}

bool Contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(RunDiagnosisTest, GoodRunGivesNoWarning) {
  EXPECT_EQ(FormatWarnings(GoodRun()), "");
  EXPECT_TRUE(DiagnosisWarnings(RunDiagnosis()).empty());
  EXPECT_TRUE(DiagnosisValues(RunDiagnosis()).empty());
  EXPECT_EQ(DescribeDiagnosis(RunDiagnosis()), "");
}

TEST(RunDiagnosisTest, WarnsOfFilters) {
  EXPECT_TRUE(Contains(WarningAfter([](RunDiagnosis* run) { run->filters->hot_pixel_ratio = 0.006; }),
                       "40 pixels are hot, 0.60 % of the sensor"));
  EXPECT_TRUE(Contains(WarningAfter([](RunDiagnosis* run) { run->filters->hot_event_ratio = 0.3; }),
                       "hot pixels made 30 % of the events"));
  EXPECT_TRUE(Contains(WarningAfter([](RunDiagnosis* run) { run->filters->flicker_event_ratio = 0.21; }),
                       "flicker at 100.0 Hz made 21 % of the events"));
  EXPECT_TRUE(Contains(WarningAfter([](RunDiagnosis* run) { run->filters->masked_pixel_ratio = 0.8; }),
                       "mask covers 80 % of the sensor"));
}

TEST(RunDiagnosisTest, WarnsOfFeatures) {
  EXPECT_TRUE(Contains(WarningAfter([](RunDiagnosis* run) { run->features->median = 74.0; }), "only 74 of 150"));
  EXPECT_TRUE(Contains(WarningAfter([](RunDiagnosis* run) { run->features->min = 19; }),
                       "only 19 features were live at 2.100000000 s"));
  EXPECT_TRUE(Contains(WarningAfter([](RunDiagnosis* run) { run->features->at_rest.moving_ratio = 0.26; }),
                       "26.0 % of the observations are by features that rest"));
  // The camera stands: features may rest.
  RunDiagnosis standing = GoodRun();
  standing.features->at_rest.ratio = 0.9;
  EXPECT_EQ(FormatWarnings(standing), "");
}

TEST(RunDiagnosisTest, NothingTrackedIsOneWarning) {
  EXPECT_TRUE(Contains(WarningAfter([](RunDiagnosis* run) {
                         run->features = FeatureDiagnosis{.wanted = 150, .min_at = 0, .at_rest = {}};
                       }),
                       "nothing was tracked"));
}

TEST(RunDiagnosisTest, MinimumOfAShortRecordingIsUnknown) {
  RunDiagnosis run = GoodRun();
  run.features->min = 0;
  run.features->min_at.reset();
  EXPECT_EQ(FormatWarnings(run), "");
  EXPECT_FALSE(Contains(FormatFeatures(*run.features), "at the least"));
}

TEST(RunDiagnosisTest, RestartsStateTheirCause) {
  const std::string once = WarningAfter([](RunDiagnosis* run) {
    run->trajectory->losses = {{1'000'000'000, 50, 40, 30}, {1'900'000'000, 12, 9, 4}, {5'000'000'000, 1, 1, 1}};
    run->trajectory->restarts = {2'000'000'000};
  });
  EXPECT_TRUE(Contains(once, "started anew once"));
  EXPECT_TRUE(Contains(once, "at 2.000000000 s (lost at 1.900000000 s with 12 features, 9 of them in the map, 4 of"))
      << once;
  const std::string often = WarningAfter([](RunDiagnosis* run) {
    run->trajectory->restarts = {1'000'000'000, 2'000'000'000, 3'000'000'000, 4'000'000'000};
  });
  EXPECT_TRUE(Contains(often, "started anew 4 times"));
  EXPECT_TRUE(often.ends_with("at 3.000000000 s, ...")) << often;
}

TEST(RunDiagnosisTest, WarnsOfTrajectory) {
  EXPECT_TRUE(Contains(WarningAfter([](RunDiagnosis* run) { run->trajectory->coverage = 0.96; }), "only 96.0 %"));
  EXPECT_TRUE(Contains(WarningAfter([](RunDiagnosis* run) { run->trajectory->scale_is_held = false; }),
                       "no ground holds its scale"));
  EXPECT_TRUE(Contains(WarningAfter([](RunDiagnosis* run) { run->trajectory->scale_covered_ratio = 0.1; }),
                       "along 10 % of the path"));
  EXPECT_TRUE(Contains(WarningAfter([](RunDiagnosis* run) { run->trajectory->position_sigma_ratio = 0.02; }),
                       "uncertain by 2.0 % of the path"));
}

TEST(RunDiagnosisTest, HandHeldCameraNeedsNoGround) {
  RunDiagnosis run = GoodRun();
  run.trajectory->scale_is_held = false;
  run.trajectory->forward_ratio = 0.3;
  EXPECT_EQ(FormatWarnings(run), "");
}

TEST(RunDiagnosisTest, ValuesHaveUniqueNames) {
  auto values = DiagnosisValues(GoodRun());
  EXPECT_EQ(values.size(), 16u);
  std::ranges::sort(values);
  const auto same = [](const auto& a, const auto& b) { return a.first == b.first; };
  EXPECT_EQ(std::ranges::adjacent_find(values, same), values.end());
}

TEST(RunDiagnosisTest, DescriptionIsOneLine) {
  RunDiagnosis run = GoodRun();
  run.features->min = 3;
  const std::string text = DescribeDiagnosis(run);
  EXPECT_FALSE(Contains(text, "\n"));
  for (const char* part : {"148 features live", "40 hot pixels", "flicker in 10.0 %", "poses for 99.5 %", "only 3"}) {
    EXPECT_TRUE(Contains(text, part)) << part << " in " << text;
  }
}

}  // namespace
}  // namespace evo::report
