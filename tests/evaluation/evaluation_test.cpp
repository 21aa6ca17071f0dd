#include "evo/evaluation/evaluation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "evaluation/straight_path.hpp"
#include "evo/core/error.hpp"

namespace evo::evaluation {
namespace {

TEST(Evaluation, ErrorOverDistanceSkipsTheFirstMetre) {
  const auto truth = StraightAhead(11, 0.4);  // 4 m
  geometry::Trajectory estimate = truth;
  for (auto& pose : estimate) {
    pose.T_world_cam =
        geometry::SE3(pose.T_world_cam.rotation(), pose.T_world_cam.translation() + Eigen::Vector3d(0, 0, 0.1));
  }
  const auto result = Evaluate(truth, estimate, std::vector{ParseAlignment("none")}, {}, {}).alignments.front();
  double expected = 0.0;
  for (int i = 3; i <= 10; ++i) expected += 0.1 / (0.4 * i) / 8.0;
  EXPECT_NEAR(result.planar.mean_over_distance, expected, 1e-12);
  EXPECT_NEAR(result.longitudinal.mean_over_distance, expected, 1e-12);
  EXPECT_NEAR(result.lateral.mean_over_distance, 0.0, 1e-12);
  const auto short_path = StraightAhead(3, 0.4);
  EXPECT_TRUE(std::isnan(Evaluate(short_path, short_path, std::vector{ParseAlignment("none")}, {}, {})
                             .alignments.front()
                             .planar.mean_over_distance));
}

TEST(Evaluation, ProjectionConfinesAllErrorsToThePlane) {
  const auto truth = StraightAhead(51, 0.4);
  geometry::Trajectory estimate = truth;
  for (auto& pose : estimate) {
    pose.T_world_cam =
        geometry::SE3(geometry::so3::Exp({0.3, 0.1, 0.2}), pose.T_world_cam.translation() + Eigen::Vector3d(0, 5.0, 0));
  }
  EvaluationOptions options;
  options.project = "xz";
  const auto evaluation = Evaluate(truth, estimate, std::vector{ParseAlignment("none")}, {}, options);
  const auto& result = evaluation.alignments.front();
  EXPECT_NEAR(result.Ape(PoseRelation::kTranslation).max, 0.0, 1e-12);
  EXPECT_LT(result.Ape(PoseRelation::kRotationRad).max, 0.2);
  EXPECT_EQ(evaluation.truth.front().T_world_cam.translation().y(), 0.0);
  EXPECT_EQ(result.aligned.front().T_world_cam.translation().y(), 0.0);
}

TEST(Evaluation, SkipsDegenerateAlignments) {
  const auto line = StraightAhead(21, 0.5);
  EvaluationOptions options;
  const auto alignments = ParseAlignments("sim3,origin-scale");
  EXPECT_THROW(Evaluate(line, line, alignments, {}, options), Error);
  options.skip_degenerate_alignments = true;
  const auto evaluation = Evaluate(line, line, alignments, {}, options);
  ASSERT_EQ(evaluation.alignments.size(), 1u);
  EXPECT_EQ(evaluation.alignments.front().alignment.name, "origin-scale");
  ASSERT_EQ(evaluation.skipped.size(), 1u);
  EXPECT_NE(evaluation.skipped.front().find("sim3"), std::string::npos);
}

TEST(Evaluation, FilesWithoutStampsHaveNoSeconds) {
  auto truth = StraightAhead(31, 0.5);
  for (std::size_t i = 0; i < truth.size(); ++i) truth[i].t = static_cast<TimeNs>(i) * kNsPerSecond;
  EvaluationOptions options;
  options.association.association = "index";
  const auto evaluation = Evaluate(truth, truth, ParseAlignments("none"), {}, options);
  EXPECT_FALSE(evaluation.has_stamps);
  EXPECT_EQ(evaluation.coverage, 1.0);
  EXPECT_EQ(evaluation.gaps, 0);
  const auto& rpe = evaluation.alignments.front().rpe;
  ASSERT_EQ(rpe.size(), 3u);  // 1f, 1s, 10m
  EXPECT_EQ(rpe[0].relations.front().statistics.count, 30);
  EXPECT_EQ(rpe[1].relations.front().statistics.count, 0);
  EXPECT_EQ(rpe[2].relations.front().statistics.count, 0);  // one crossing in 15 m makes no pair
  options.rpe.required = true;
  options.rpe.deltas = "1s";
  EXPECT_THROW(Evaluate(truth, truth, ParseAlignments("none"), {}, options), Error);
  options.rpe = {};
  EXPECT_THROW(Evaluate(truth, truth, ParseAlignments("sim3:5s"), {}, options), Error);
}

TEST(Evaluation, CountsPathCoverageAndGaps) {
  const auto truth = StraightAhead(201, 0.5);  // 10 s, 100 m
  geometry::Trajectory estimate;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double t = ToSeconds(truth[i].t);
    if (t >= 2.0 && (t <= 5.0 || t >= 6.0)) estimate.push_back(truth[i]);
  }
  const auto evaluation = Evaluate(truth, estimate, std::vector{ParseAlignment("none")}, {}, {});
  EXPECT_EQ(evaluation.gaps, 2);  // before 2 s and from 5 s to 6 s
  EXPECT_NEAR(evaluation.coverage, 0.7, 1e-12);
  EXPECT_NEAR(evaluation.path_m, 80.0, 1e-9);
  const auto& errors = evaluation.alignments.front().errors;
  EXPECT_NEAR(errors.back().distance, 80.0, 1e-9);
  EXPECT_NEAR(errors.front().seconds, 2.0, 1e-12);

  const EvaluationInterval interval{4 * kNsPerSecond, 8 * kNsPerSecond};
  const auto part = Evaluate(truth, estimate, std::vector{ParseAlignment("none")}, interval, {});
  EXPECT_EQ(part.gaps, 1);
  EXPECT_NEAR(part.coverage, 0.75, 1e-12);
  EXPECT_NEAR(part.path_m, 40.0, 1e-9);
}

TEST(Evaluation, SignedErrorsAndTheirSummary) {
  const auto truth = StraightAhead(101, 0.5);
  geometry::Trajectory estimate = truth;
  for (auto& pose : estimate) {
    const Eigen::Vector3d p = pose.T_world_cam.translation();
    pose.T_world_cam = geometry::SE3(pose.T_world_cam.rotation(), {0.01 * p.z(), 0, 0.98 * p.z()});
  }
  const auto evaluation = Evaluate(truth, estimate, std::vector{ParseAlignment("none")}, {}, {});
  const auto& result = evaluation.alignments.front();
  EXPECT_NEAR(result.longitudinal.final, -1.0, 1e-9);  // 2 % short of 50 m
  EXPECT_NEAR(result.lateral.final, -0.5, 1e-9);       // to the right
  EXPECT_NEAR(result.longitudinal.mean_abs, 0.5, 1e-9);
  EXPECT_NEAR(result.longitudinal.max_abs, 1.0, 1e-9);
  EXPECT_NEAR(result.planar.final, std::hypot(1.0, 0.5), 1e-9);
  EXPECT_NEAR(result.vertical.rmse, 0.0, 1e-12);
}

TEST(Evaluation, RotationErrorIsAnAngle) {
  const auto truth = StraightAhead(11, 0.5);
  geometry::Trajectory estimate = truth;
  for (auto& pose : estimate) {
    pose.T_world_cam =
        geometry::SE3(geometry::so3::Exp({0, 0.1, 0}) * pose.T_world_cam.rotation(), pose.T_world_cam.translation());
  }
  const auto result = Evaluate(truth, estimate, std::vector{ParseAlignment("none")}, {}, {}).alignments.front();
  EXPECT_NEAR(result.Ape(PoseRelation::kRotationDeg).mean, 0.1 * 180.0 / std::numbers::pi, 1e-9);
  EXPECT_NEAR(result.Ape(PoseRelation::kTranslation).max, 0.0, 1e-12);
}

}  // namespace
}  // namespace evo::evaluation
