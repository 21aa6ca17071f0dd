#include "odometry/bundle/motion_prior.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>
#include <vector>

namespace evo::odometry {
namespace {

geometry::Vector6d Twist(std::mt19937* random, double translation, double rotation) {
  std::normal_distribution<double> normal;
  geometry::Vector6d twist;
  for (int k = 0; k < 6; ++k) twist[k] = (k < 3 ? translation : rotation) * normal(*random);
  return twist;
}

TEST(MotionPrior, IsZeroAtConstantVelocity) {
  std::mt19937 random(1);
  const geometry::Vector6d velocity = Twist(&random, 5.0, 1.0);
  const geometry::SE3 here = geometry::SE3::Exp(Twist(&random, 3.0, 1.0));
  const geometry::Vector6d change = ComputeVelocityChange(
      {geometry::SE3::Exp(-0.02 * velocity) * here, here, geometry::SE3::Exp(0.05 * velocity) * here},
      {0.0, 0.02, 0.07}, 1);
  EXPECT_LT(change.norm(), 1e-9);
}

TEST(MotionPrior, JacobiansMatchFiniteDifferences) {
  constexpr double kStep = 1e-6;
  std::mt19937 random(2);
  for (int trial = 0; trial < 20; ++trial) {
    const geometry::SE3 before = geometry::SE3::Exp(Twist(&random, 3.0, 1.0));
    const geometry::SE3 here = geometry::SE3::Exp(Twist(&random, 0.3, 0.05)) * before;
    const geometry::SE3 after = geometry::SE3::Exp(Twist(&random, 0.3, 0.05)) * here;
    const std::vector<geometry::SE3> poses = {before, here, after};
    const std::vector<double> times_s = {0.0, 0.02, 0.05};
    const auto change = LinearizeVelocityChange(poses, times_s, 1);
    EXPECT_LT((change.value - ComputeVelocityChange(poses, times_s, 1)).norm(), 1e-9);
    for (const auto& [pose, J] : {std::pair(0, change.J_previous), {1, change.J_current}, {2, change.J_next}}) {
      geometry::Matrix6d numeric;
      for (int k = 0; k < 6; ++k) {
        const auto moved = [&, pose = pose](double step) {
          std::vector<geometry::SE3> with = poses;
          with[pose] = geometry::SE3::Exp(step * geometry::Vector6d::Unit(k)) * with[pose];
          return ComputeVelocityChange(with, times_s, 1);
        };
        numeric.col(k) = (moved(kStep) - moved(-kStep)) / (2.0 * kStep);
      }
      EXPECT_LT((J - numeric).norm(), 1e-4 * numeric.norm()) << trial << " " << pose;
    }
  }
}

TEST(MotionPrior, EstimatesTheTypicalChange) {
  constexpr double kTranslation = 0.5;  // per s^1.5
  constexpr double kRotation = 0.1;
  std::mt19937 random(3);
  std::vector<geometry::SE3> poses(1);
  std::vector<double> times_s = {0.0};
  geometry::Vector6d velocity = geometry::Vector6d::Zero();
  for (int i = 0; i < 2000; ++i) {
    const double step = i % 3 == 0 ? 0.04 : 0.02;
    if (i > 0)
      velocity += std::sqrt(0.5 * (step + times_s[i] - times_s[i - 1])) * Twist(&random, kTranslation, kRotation);
    poses.push_back(geometry::SE3::Exp(step * velocity) * poses.back());
    times_s.push_back(times_s.back() + step);
  }
  const MotionPrior prior = EstimateMotionPrior(poses, times_s, 2.0, 0.3);
  EXPECT_EQ(prior.times_s, times_s);
  EXPECT_NEAR(prior.translation_weight_px, 0.3 / (2.0 * kTranslation), 0.05 * prior.translation_weight_px);
  EXPECT_NEAR(prior.rotation_weight_px, 0.3 / (2.0 * kRotation), 0.05 * prior.rotation_weight_px);
}

TEST(MotionPrior, IsEmptyForFewPosesOrWithoutMotion) {
  EXPECT_TRUE(EstimateMotionPrior({geometry::SE3(), geometry::SE3()}, {0.0, 1.0}, 2.0, 0.3).times_s.empty());
  EXPECT_TRUE(EstimateMotionPrior(std::vector<geometry::SE3>(5), {0.0, 1.0, 2.0, 3.0, 4.0}, 2.0, 0.3).times_s.empty());
}

}  // namespace
}  // namespace evo::odometry
