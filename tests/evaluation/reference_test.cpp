// The numbers that evo 1.36.5 prints for the same files, and the driving errors computed independently.
#include "reference.hpp"

#include <gtest/gtest.h>

#include <string>

#include "evo/core/error.hpp"
#include "evo/evaluation/evaluation.hpp"

namespace evo {
namespace {

constexpr double kTolerance = 1e-9;

EvaluationOptions EvoRules() {
  EvaluationOptions options;
  options.association.association = "nearest";
  return options;
}

class EvoReference : public ::testing::TestWithParam<std::string> {
 protected:
  Evaluation Run(const Alignment& alignment, const EvaluationOptions& options,
                 const EvaluationInterval& interval = {}) {
    return Evaluate(truth, estimate, std::vector{alignment}, interval, options);
  }

  void ExpectMatches(const std::string& row_name, const Evaluation& evaluation) {
    for (const auto& row : ReadReferenceTable("reference.csv")) {
      if (row.at("name") != row_name + "_" + GetParam()) continue;
      const Statistics& ape = evaluation.alignments.front().ape;
      EXPECT_EQ(ape.count, std::stoll(row.at("n")));
      EXPECT_NEAR(ape.rmse, std::stod(row.at("rmse")), kTolerance);
      EXPECT_NEAR(ape.mean, std::stod(row.at("mean")), kTolerance);
      EXPECT_NEAR(ape.median, std::stod(row.at("median")), kTolerance);
      EXPECT_NEAR(ape.standard_deviation, std::stod(row.at("std")), kTolerance);
      EXPECT_NEAR(ape.min, std::stod(row.at("min")), kTolerance);
      EXPECT_NEAR(ape.max, std::stod(row.at("max")), kTolerance);
      EXPECT_NEAR(ape.sse / std::stod(row.at("sse")), 1.0, kTolerance);
      return;
    }
    ADD_FAILURE() << "no row " << row_name << "_" << GetParam();
  }

  Trajectory truth = ReadReferenceTrajectory("gt.txt");
  Trajectory estimate = ReadReferenceTrajectory(GetParam() + ".txt");
};

TEST_P(EvoReference, Unaligned) { ExpectMatches("ape_none", Run(ParseAlignment("none"), EvoRules())); }
TEST_P(EvoReference, Se3) { ExpectMatches("ape_se3", Run(ParseAlignment("se3"), EvoRules())); }
TEST_P(EvoReference, Sim3) { ExpectMatches("ape_sim3", Run(ParseAlignment("sim3"), EvoRules())); }
TEST_P(EvoReference, Origin) { ExpectMatches("ape_origin", Run(ParseAlignment("origin"), EvoRules())); }

TEST_P(EvoReference, Sim3OnTheFirstHundredPoses) {
  const EvaluationOptions options = EvoRules();
  const auto pairs = Associate(truth, estimate, options.association);
  const double seconds = ToSeconds(pairs.at(99).t_truth - pairs.front().t_truth) + 1e-6;
  ExpectMatches("ape_sim3_n100", Run({Alignment::Kind::kFirst, seconds, "first"}, options));
}

TEST_P(EvoReference, ClockOffset) {
  EvaluationOptions options = EvoRules();
  options.association.estimate_clock_offset_s = -0.003;
  ExpectMatches("ape_se3_off", Run(ParseAlignment("se3"), options));
}

TEST_P(EvoReference, Window) {
  const EvaluationInterval interval{1506117922 * kNsPerSecond, 1506117952 * kNsPerSecond};
  ExpectMatches("ape_se3_win", Run(ParseAlignment("se3"), EvoRules(), interval));
}

TEST_P(EvoReference, ToleranceOfTwoMilliseconds) {
  EvaluationOptions options = EvoRules();
  options.association.max_difference_s = 0.002;
  if (GetParam() == "est_dense") {
    ExpectMatches("ape_se3_d002", Run(ParseAlignment("se3"), options));
    return;
  }
  try {  // the estimates are 3 ms off
    Run(ParseAlignment("se3"), options);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kNothingToDo);
  }
}

INSTANTIATE_TEST_SUITE_P(Ape, EvoReference, ::testing::Values("est_sim3", "est_se3", "est_dense", "est_drift"),
                         [](const auto& test) { return test.param; });

TEST(DrivingReference, SplitsAlongTheDirectionOfTravel) {
  EvaluationOptions options = EvoRules();
  const auto evaluation = Evaluate(ReadReferenceTrajectory("gt.txt"), ReadReferenceTrajectory("est_drift.txt"),
                                   std::vector{ParseAlignment("none")}, {}, options);
  const auto rows = ReadReferenceTable("lonlat_reference.csv");
  const auto& expected = rows.at(1);
  ASSERT_EQ(expected.at("frame"), "travel");
  const auto& result = evaluation.alignments.front();
  const auto value = [&](const char* column) { return std::stod(expected.at(column)); };
  EXPECT_EQ(result.ape.count, std::stoll(expected.at("n")));
  EXPECT_NEAR(evaluation.path_m, value("path_m"), kTolerance);
  EXPECT_NEAR(result.longitudinal.mean_abs, value("mean_abs_lon"), kTolerance);
  EXPECT_NEAR(result.lateral.mean_abs, value("mean_abs_lat"), kTolerance);
  EXPECT_NEAR(result.planar.mean_abs, value("mean_planar"), kTolerance);
  EXPECT_NEAR(result.planar.rmse, value("rmse_planar"), kTolerance);
  EXPECT_NEAR(result.longitudinal.max_abs, value("max_lon"), kTolerance);
  EXPECT_NEAR(result.lateral.max_abs, value("max_lat"), kTolerance);
  EXPECT_NEAR(result.planar.max_abs, value("max_planar"), kTolerance);
  EXPECT_NEAR(result.planar.final, value("final_planar"), kTolerance);
  EXPECT_NEAR(100.0 * result.planar.max_abs / evaluation.path_m, value("max_planar_pct"), kTolerance);
}

}  // namespace
}  // namespace evo
