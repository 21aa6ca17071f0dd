#include "evo/odometry/depth_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace evo {
namespace {

constexpr double kFocal = 226.0;
constexpr double kPxAngle = 1.0 / kFocal;

Feature See(std::int64_t track, const Eigen::Vector3d& point_cam, const Eigen::Vector2d& noise_px = {0, 0}) {
  return {track, point_cam.head<2>() / point_cam.z() + noise_px / kFocal, kFocal * Eigen::Matrix2d::Identity()};
}

/// The camera after `i` steps of sideways motion, relative to the key frame.
SE3 Sideways(int i) { return {{1, 0, 0, 0}, Eigen::Vector3d(-0.1 * i, 0, 0)}; }

TEST(DepthFilter, UncertaintyIsTheChangeOfDepthByOneAngle) {
  const Eigen::Vector3d ray = Eigen::Vector3d(0.1, 0.05, 1.0).normalized();
  const Eigen::Vector3d t(0.8, 0.0, 0.1);
  const double z = 9.0, angle = 1e-6;
  // Turn the second camera's ray towards the first by a small angle within the epipolar plane and intersect again.
  const Eigen::Vector3d axis = t.cross(ray).normalized();
  const Eigen::Vector3d turned = Eigen::AngleAxisd(-angle, axis) * (z * ray - t).normalized();
  const double other = (t.cross(turned)).dot(ray.cross(turned)) / ray.cross(turned).squaredNorm();
  EXPECT_NEAR(DepthUncertainty(ray, t, z, angle), std::abs(other - z), 1e-3 * std::abs(other - z));
}

TEST(DepthFilter, MomentsAreThoseOfThePosterior) {
  Seed seed{.a = 12, .b = 7, .mu = 0.12, .z_range = 0.4, .sigma2 = 0.02 * 0.02};
  const double x = 0.15, tau = 0.03;
  const Seed before = seed;
  UpdateSeed(x, tau, &seed);
  // The same by brute force: posterior ~ (p N(x; z, tau^2) + (1 - p) / range) N(z; mu, sigma^2) Beta(p; a, b).
  double sum = 0, mean = 0, square = 0, share = 0;
  for (double z = 0.0; z < 0.3; z += 5e-4) {
    const double prior = std::exp(-0.5 * std::pow((z - before.mu), 2) / before.sigma2);
    const double good = std::exp(-0.5 * std::pow((x - z) / tau, 2)) / (tau * std::sqrt(2 * M_PI));
    for (double p = 0.0025; p < 1.0; p += 0.005) {
      const double beta = std::pow(p, before.a - 1) * std::pow(1 - p, before.b - 1);
      const double w = (p * good + (1 - p) / before.z_range) * prior * beta;
      sum += w;
      mean += w * z;
      square += w * z * z;
      share += w * p;
    }
  }
  EXPECT_NEAR(seed.mu, mean / sum, 1e-5);
  EXPECT_NEAR(seed.sigma2, square / sum - std::pow(mean / sum, 2), 1e-6);
  EXPECT_NEAR(seed.inlier_ratio(), share / sum, 1e-4);
}

TEST(DepthFilter, ConvergesToTheTrueDepthAndReportsItOnce) {
  const Eigen::Vector3d point(0.7, -0.3, 5.0);
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 0.4);
  std::vector<Seed> converged;
  DepthFilter filter({.pixel_noise = 0.5, .convergence = 100}, kPxAngle,
                     [&](const Seed& s) { converged.push_back(s); });
  filter.AddSeed(See(7, point), 0, 8.0, 1.0);
  filter.AddSeed(See(7, point), 0, 2.0, 1.0);  // the track has one already
  ASSERT_EQ(filter.seeds().size(), 1u);
  for (int i = 1; i < 20; ++i) {
    const Frame frame{0, {}, {See(7, Sideways(i) * point, {noise(random), noise(random)})}};
    filter.Update(frame, [&](int) { return Sideways(i); });
  }
  ASSERT_EQ(converged.size(), 1u);
  EXPECT_FALSE(filter.Has(7));
  EXPECT_NEAR(1.0 / converged[0].mu, point.norm(), 0.05 * point.norm());
  EXPECT_LT(std::sqrt(converged[0].sigma2), 0.01);
}

TEST(DepthFilter, DropsATrackThatMovesByItself) {
  int converged = 0;
  DepthFilter filter({}, kPxAngle, [&](const Seed&) { ++converged; });
  Eigen::Vector3d point(0.7, -0.3, 5.0);
  filter.AddSeed(See(1, point), 0, 5.0, 1.0);
  for (int i = 1; i < 30; ++i) {
    point.y() += 0.2;  // across the epipolar line
    filter.Update({0, {}, {See(1, Sideways(i) * point)}}, [&](int) { return Sideways(i); });
  }
  EXPECT_EQ(converged, 0);
  EXPECT_TRUE(filter.seeds().empty());
}

TEST(DepthFilter, WithoutMotionNothingConverges) {
  int converged = 0;
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 0.3);
  DepthFilter filter({}, kPxAngle, [&](const Seed&) { ++converged; });
  const Eigen::Vector3d point(0.7, -0.3, 5.0);
  filter.AddSeed(See(1, point), 0, 5.0, 1.0);
  for (int i = 1; i < 200; ++i) {
    filter.Update({0, {}, {See(1, point, {noise(random), noise(random)})}}, [](int) { return SE3(); });
  }
  EXPECT_EQ(converged, 0);
}

TEST(DepthFilter, ForgetsOldSeeds) {
  DepthFilter filter({.max_age = 3}, kPxAngle, [](const Seed&) {});
  filter.AddSeed(See(1, {0, 0, 5}), 2, 5.0, 1.0);
  filter.DropOld(5);
  EXPECT_TRUE(filter.Has(1));
  filter.DropOld(6);
  EXPECT_FALSE(filter.Has(1));
}

}  // namespace
}  // namespace evo
