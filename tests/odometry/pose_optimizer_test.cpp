#include "odometry/frontend/pose_optimizer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace evo::odometry {
namespace {

geometry::SE3 Truth() { return {geometry::so3::Exp({0.05, -0.2, 0.02}), Eigen::Vector3d(0.4, -0.1, -3.0)}; }

std::vector<PoseObservation> Scene(int count, double noise_px, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> side(-0.6, 0.6), depth(4.0, 40.0);
  std::normal_distribution<double> normal(0.0, noise_px);
  std::vector<PoseObservation> observations;
  for (int i = 0; i < count; ++i) {
    const double z = depth(random);
    const Eigen::Vector3d p(side(random) * z, side(random) * z, z);
    Eigen::Matrix2d J_pixel_normalized;
    J_pixel_normalized << 220.0, 5.0, 5.0, 210.0;
    const Eigen::Vector2d noise(normal(random), normal(random));
    observations.push_back(
        {Truth().Inverse() * p, p.head<2>() / p.z() + J_pixel_normalized.inverse() * noise, J_pixel_normalized});
  }
  return observations;
}

double Distance(const geometry::SE3& a, const geometry::SE3& b) { return (a * b.Inverse()).Log().norm(); }

TEST(PoseOptimizer, JacobianMatchesFiniteDifferences) {
  for (const auto& observation : Scene(5, 20.0, 1)) {
    const auto jacobian = ReprojectionJacobian(Truth(), observation);
    for (int i = 0; i < 6; ++i) {
      const geometry::Vector6d d = 1e-6 * geometry::Vector6d::Unit(i);
      const Eigen::Vector2d numeric = (ReprojectionError(geometry::SE3::Exp(d) * Truth(), observation) -
                                       ReprojectionError(geometry::SE3::Exp(-d) * Truth(), observation)) /
                                      2e-6;
      EXPECT_LT((jacobian.col(i) - numeric).norm(), 1e-4) << i;
    }
  }
}

TEST(PoseOptimizer, IsExactWithoutNoiseFromAPoorStart) {
  const PoseOptimizer optimizer({});
  const geometry::SE3 start =
      geometry::SE3::Exp((geometry::Vector6d() << 0.5, -0.3, 0.6, 0.05, 0.04, -0.05).finished()) * Truth();
  const auto estimate = optimizer.Optimize(Scene(50, 0.0, 2), start);
  EXPECT_EQ(estimate.inlier_count, 50);
  EXPECT_LT(Distance(estimate.T_cam_world, Truth()), 1e-7);
  EXPECT_TRUE(optimizer.Accepts(estimate));
}

TEST(PoseOptimizer, IsRobustAgainstThirtyPercentOutliers) {
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    auto observations = Scene(80, 0.4, seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> far(0.05, 0.2);
    for (int i = 0; i < 24; ++i) observations[3 * i].x += Eigen::Vector2d(far(random), -far(random));
    const PoseOptimizer optimizer({});
    const auto estimate =
        optimizer.Optimize(observations, geometry::SE3::Exp(geometry::Vector6d::Constant(0.02)) * Truth());
    EXPECT_LT(Distance(estimate.T_cam_world, Truth()), 0.05) << seed;
    EXPECT_GE(estimate.inlier_count, 52) << seed;
    EXPECT_LE(estimate.inlier_count, 58) << seed;
    EXPECT_NEAR(estimate.scale_px, 0.4, 0.3) << seed;
  }
}

TEST(PoseOptimizer, CovariancePredictsTheErrors) {
  geometry::Matrix6d spread = geometry::Matrix6d::Zero(), predicted = spread;
  const int trials = 200;
  for (int trial = 0; trial < trials; ++trial) {
    const auto estimate = PoseOptimizer({}).Optimize(Scene(60, 0.4, 100 + trial), Truth());
    const geometry::Vector6d error = (estimate.T_cam_world * Truth().Inverse()).Log();
    spread += error * error.transpose() / trials;
    predicted += estimate.covariance / trials;
  }
  EXPECT_NEAR(std::sqrt(spread(2, 2) / predicted(2, 2)), 1.0, 0.25);
  EXPECT_NEAR(std::sqrt(spread(4, 4) / predicted(4, 4)), 1.0, 0.25);
}

TEST(PoseOptimizer, RejectsTooFewPoints) {
  const PoseOptimizer optimizer({});
  EXPECT_FALSE(optimizer.Accepts(optimizer.Optimize(Scene(2, 0.0, 1), Truth())));
  EXPECT_FALSE(optimizer.Accepts(optimizer.Optimize(Scene(5, 0.0, 1), Truth())));
}

}  // namespace
}  // namespace evo::odometry
