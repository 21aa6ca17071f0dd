#include "evaluation/trajectory/relative_pose_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "evo/core/error.hpp"
#include "evo/evaluation/evaluation.hpp"

namespace evo::evaluation {
namespace {

geometry::Trajectory Curve(int poses, double noise) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0.0, noise);
  geometry::Trajectory trajectory;
  for (int i = 0; i < poses; ++i) {
    const double s = 0.1 * i;
    const Eigen::Vector3d shift(normal(random), normal(random), normal(random));
    const Eigen::Vector3d turn(normal(random), normal(random), normal(random));
    trajectory.push_back(
        {FromSeconds(s),
         geometry::SE3(geometry::so3::Exp({0.1 * s, 0.3 * std::sin(s), -0.2 * s}) * geometry::so3::Exp(0.1 * turn),
                       Eigen::Vector3d(3.0 * s, std::sin(0.7 * s), 0.2 * s * s) + shift)});
  }
  return trajectory;
}

geometry::Trajectory Moved(geometry::Trajectory trajectory, const Similarity& similarity) {
  for (auto& pose : trajectory) pose.T_world_cam = similarity * pose.T_world_cam;
  return trajectory;
}

std::vector<RelativePoseError> Rpe(const geometry::Trajectory& truth, const geometry::Trajectory& estimate,
                                   const std::string& pairs, const std::string& deltas = "1f,5f,1s,3m,10deg") {
  EvaluationOptions options;
  options.rpe.deltas = deltas;
  options.rpe.pairs = pairs;
  options.rpe.tolerance = 0.2;
  return Evaluate(truth, estimate, std::vector{ParseAlignment("none")}, {}, options).alignments.front().rpe;
}

TEST(RelativePoseError, DoesNotDependOnEitherWorldFrame) {
  const auto truth = Curve(200, 0.0);
  const auto estimate = Curve(200, 0.02);
  const Similarity motion{1.0, geometry::SE3(geometry::so3::Exp({0.4, -1.2, 2.0}), {100.0, -20.0, 3.0})};
  for (const char* selection : {"consecutive", "all", "closest"}) {
    const auto expected = Rpe(truth, estimate, selection);
    for (const auto& moved : {Rpe(truth, Moved(estimate, motion), selection),
                              Rpe(Moved(truth, motion), Moved(estimate, motion), selection)}) {
      for (std::size_t i = 0; i < expected.size(); ++i) {
        for (const auto& [relation, statistics] : expected[i].relations) {
          const auto& other = Find(moved[i].relations, relation);
          EXPECT_GT(statistics.count, 0) << expected[i].delta.name << selection;
          EXPECT_EQ(other.count, statistics.count) << expected[i].delta.name << selection;
          EXPECT_NEAR(other.rmse, statistics.rmse, 1e-9) << expected[i].delta.name << selection;
        }
      }
    }
  }
}

TEST(RelativePoseError, GrowsWithTheScaleError) {
  const auto truth = Curve(100, 0.0);
  const auto rpe = Rpe(truth, Moved(truth, {1.1, geometry::SE3()}), "all", "7f").front().relations;
  EXPECT_NEAR(Find(rpe, PoseRelation::kPointDistanceRatio).min, 10.0, 1e-9);
  EXPECT_NEAR(Find(rpe, PoseRelation::kPointDistanceRatio).max, 10.0, 1e-9);
  EXPECT_NEAR(Find(rpe, PoseRelation::kTranslation).mean, Find(rpe, PoseRelation::kPointDistance).mean, 1e-12);
  EXPECT_NEAR(Find(rpe, PoseRelation::kRotationRad).max, 0.0, 1e-7);
}

TEST(RelativePoseError, AllRelationsOfAKnownMotion) {
  // The truth moves 2 m ahead; the estimate 2 m ahead and 1 m aside while it turns by 0.5 rad.
  const geometry::Trajectory truth{{0, geometry::SE3()},
                                   {kNsPerSecond, geometry::SE3(Eigen::Quaterniond::Identity(), {0, 0, 2})}};
  const geometry::Trajectory estimate{{0, geometry::SE3()},
                                      {kNsPerSecond, geometry::SE3(geometry::so3::Exp({0, 0.5, 0}), {1, 0, 2})}};
  const auto rpe = Rpe(truth, estimate, "consecutive", "1f").front().relations;
  const double frobenius = 2.0 * std::numbers::sqrt2 * std::sin(0.25);
  const std::pair<PoseRelation, double> expected[] = {
      {PoseRelation::kTranslation, 1.0},
      {PoseRelation::kRotationRad, 0.5},
      {PoseRelation::kRotationDeg, 0.5 * 180.0 / std::numbers::pi},
      {PoseRelation::kRotationFrobenius, frobenius},
      {PoseRelation::kFull, std::sqrt(1.0 + frobenius * frobenius)},
      {PoseRelation::kPointDistance, std::sqrt(5.0) - 2.0},
      {PoseRelation::kPointDistanceRatio, 50.0 * (std::sqrt(5.0) - 2.0)}};
  for (const auto& [relation, value] : expected) {
    EXPECT_NEAR(Find(rpe, relation).rmse, value, 1e-12) << QuantityName(relation);
  }
  EXPECT_NEAR(Find(rpe, PoseRelation::kFull).rmse,
              (estimate[1].T_world_cam.Matrix() - truth[1].T_world_cam.Matrix()).norm(), 1e-12);
}

TEST(RelativePoseError, StandingStillHasNoRatio) {
  geometry::Trajectory still;
  for (int i = 0; i < 10; ++i) still.push_back({i * kNsPerSecond, geometry::SE3()});
  const auto rpe = Rpe(still, still, "consecutive", "1f").front().relations;
  EXPECT_EQ(Find(rpe, PoseRelation::kPointDistance).count, 9);
  EXPECT_EQ(Find(rpe, PoseRelation::kPointDistanceRatio).count, 0);
  EXPECT_TRUE(std::isnan(Find(rpe, PoseRelation::kPointDistanceRatio).rmse));
}

TEST(RelativePoseError, TooLongDeltasAreEmptyOrRefused) {
  const auto truth = Curve(20, 0.0);
  EvaluationOptions options;
  options.rpe.deltas = "1000m";
  const auto rpe = Evaluate(truth, truth, std::vector{ParseAlignment("none")}, {}, options).alignments.front().rpe;
  EXPECT_EQ(rpe.front().relations.front().statistics.count, 0);
  options.rpe.required = true;
  try {
    Evaluate(truth, truth, std::vector{ParseAlignment("none")}, {}, options);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kNothingToDo);
    EXPECT_NE(std::string(error.what()).find("1000m"), std::string::npos);
  }
}

TEST(RelativePoseError, PairsMayFollowTheTruth) {
  const auto truth = Curve(100, 0.0);
  const auto estimate = Moved(truth, {2.0, geometry::SE3()});
  EvaluationOptions options;
  options.rpe.deltas = "3m";
  options.rpe.pairs_from = "truth";
  const auto of_truth = Evaluate(truth, estimate, std::vector{ParseAlignment("none")}, {}, options);
  options.rpe.pairs_from = "estimate";
  options.rpe.deltas = "6m";
  const auto of_estimate = Evaluate(truth, estimate, std::vector{ParseAlignment("none")}, {}, options);
  const auto& a = of_truth.alignments.front().rpe.front().relations.front().statistics;
  const auto& b = of_estimate.alignments.front().rpe.front().relations.front().statistics;
  EXPECT_GT(a.count, 5);
  EXPECT_EQ(a.count, b.count);
  EXPECT_DOUBLE_EQ(a.rmse, b.rmse);
}

}  // namespace
}  // namespace evo::evaluation
