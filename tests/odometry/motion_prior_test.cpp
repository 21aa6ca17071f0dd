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

TEST(MotionPrior, AConstantVelocityCostsNothing) {
  std::mt19937 random(1);
  const geometry::Vector6d velocity = Twist(&random, 5.0, 1.0);
  const geometry::SE3 here = geometry::SE3::Exp(Twist(&random, 3.0, 1.0));
  const geometry::Vector6d change = MeasureVelocityChange(
      {geometry::SE3::Exp(-0.02 * velocity) * here, here, geometry::SE3::Exp(0.05 * velocity) * here},
      {0.0, 0.02, 0.07}, 1);
  EXPECT_LT(change.norm(), 1e-9);
}

TEST(MotionPrior, DerivativesMatchFiniteDifferences) {
  constexpr double kStep = 1e-6;
  std::mt19937 random(2);
  for (int trial = 0; trial < 20; ++trial) {
    const geometry::SE3 before = geometry::SE3::Exp(Twist(&random, 3.0, 1.0));
    const geometry::SE3 here = geometry::SE3::Exp(Twist(&random, 0.3, 0.05)) * before;
    const geometry::SE3 after = geometry::SE3::Exp(Twist(&random, 0.3, 0.05)) * here;
    const std::vector<geometry::SE3> poses = {before, here, after};
    const std::vector<double> t = {0.0, 0.02, 0.05};
    const auto change = LinearizeVelocityChange(poses, t, 1);
    EXPECT_LT((change.value - MeasureVelocityChange(poses, t, 1)).norm(), 1e-9);
    for (const auto& [pose, by] : {std::pair(0, change.by_before), {1, change.by_here}, {2, change.by_after}}) {
      geometry::Matrix6d numeric;
      for (int k = 0; k < 6; ++k) {
        const auto moved = [&, pose = pose](double step) {
          std::vector<geometry::SE3> with = poses;
          with[pose] = geometry::SE3::Exp(step * geometry::Vector6d::Unit(k)) * with[pose];
          return MeasureVelocityChange(with, t, 1);
        };
        numeric.col(k) = (moved(kStep) - moved(-kStep)) / (2.0 * kStep);
      }
      EXPECT_LT((by - numeric).norm(), 1e-4 * numeric.norm()) << trial << " " << pose;
    }
  }
}

TEST(MotionPrior, MeasuresWhatIsUsual) {
  constexpr double kTranslation = 0.5;  // per s^1.5
  constexpr double kRotation = 0.1;
  std::mt19937 random(3);
  std::vector<geometry::SE3> poses(1);
  std::vector<double> t = {0.0};
  geometry::Vector6d velocity = geometry::Vector6d::Zero();
  for (int i = 0; i < 2000; ++i) {
    const double step = i % 3 == 0 ? 0.04 : 0.02;
    if (i > 0) velocity += std::sqrt(0.5 * (step + t[i] - t[i - 1])) * Twist(&random, kTranslation, kRotation);
    poses.push_back(geometry::SE3::Exp(step * velocity) * poses.back());
    t.push_back(t.back() + step);
  }
  const MotionPrior prior = MeasureMotion(poses, t, 2.0, 0.3);
  EXPECT_EQ(prior.t, t);
  EXPECT_NEAR(prior.translation_px, 0.3 / (2.0 * kTranslation), 0.05 * prior.translation_px);
  EXPECT_NEAR(prior.rotation_px, 0.3 / (2.0 * kRotation), 0.05 * prior.rotation_px);
}

TEST(MotionPrior, NothingIsUsualForAFewPosesOrWithoutMotion) {
  EXPECT_TRUE(MeasureMotion({geometry::SE3(), geometry::SE3()}, {0.0, 1.0}, 2.0, 0.3).t.empty());
  EXPECT_TRUE(MeasureMotion(std::vector<geometry::SE3>(5), {0.0, 1.0, 2.0, 3.0, 4.0}, 2.0, 0.3).t.empty());
}

}  // namespace
}  // namespace evo::odometry
