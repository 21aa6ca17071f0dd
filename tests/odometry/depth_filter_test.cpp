#include "odometry/mapping/depth_filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace evo::odometry {
namespace {

constexpr double kFocal = 226.0;
constexpr double kPixelAngle = 1.0 / kFocal;

Feature Observe(std::int64_t track, const Eigen::Vector3d& point_cam, const Eigen::Vector2d& noise_px = {0, 0}) {
  return {track, point_cam.head<2>() / point_cam.z() + noise_px / kFocal, kFocal * Eigen::Matrix2d::Identity()};
}

/// The camera after `i` steps of sideways motion, relative to the key frame.
geometry::SE3 Sideways(int i) { return {{1, 0, 0, 0}, Eigen::Vector3d(-0.1 * i, 0, 0)}; }

TEST(DepthFilter, UncertaintyIsTheDepthErrorOfAnAngle) {
  const Eigen::Vector3d ray = Eigen::Vector3d(0.1, 0.05, 1.0).normalized();
  const Eigen::Vector3d t(0.8, 0.0, 0.1);
  const double z = 9.0, angle = 1e-6;
  // Rotate the second camera's ray towards the first by a small angle in the epipolar plane and intersect again.
  const Eigen::Vector3d axis = t.cross(ray).normalized();
  const Eigen::Vector3d rotated = Eigen::AngleAxisd(-angle, axis) * (z * ray - t).normalized();
  const double other = (t.cross(rotated)).dot(ray.cross(rotated)) / ray.cross(rotated).squaredNorm();
  EXPECT_NEAR(DepthUncertainty(ray, t, z, angle), std::abs(other - z), 1e-3 * std::abs(other - z));
}

struct Measurement {
  double x;    // inverse distance
  double tau;  // its standard deviation
};

struct Posterior {
  double mean, sigma;  // of the inverse distance
  double ratio, ratio_sigma;
};

Posterior Approximate(const Seed& seed) {
  const double ratio = seed.inlier_ratio();
  return {seed.mu, std::sqrt(seed.sigma2), ratio, std::sqrt(ratio * (1.0 - ratio) / (seed.a + seed.b + 1.0))};
}

/// The exact posterior of inverse distance z and inlier probability p on a grid: proportional to N(z; mu, sigma^2)
/// Beta(p; a, b) times p N(x; z, tau^2) + (1 - p) / z_range for each measurement (equation 8).
Posterior Exact(const Seed& prior, const std::vector<Measurement>& measurements) {
  constexpr int kDistances = 1000, kRatios = 40;
  double sum = 0, z_sum = 0, zz_sum = 0, p_sum = 0, pp_sum = 0;
  std::vector<double> densities(measurements.size());
  for (int i = 0; i < kDistances; ++i) {
    const double sigmas = -6.0 + 12.0 * i / kDistances;
    const double z = prior.mu + sigmas * std::sqrt(prior.sigma2);
    for (std::size_t k = 0; k < measurements.size(); ++k) {
      const auto& [x, tau] = measurements[k];
      densities[k] = std::exp(-0.5 * std::pow((x - z) / tau, 2)) / (tau * std::sqrt(2 * M_PI));
    }
    for (int j = 0; j < kRatios; ++j) {
      const double p = (j + 0.5) / kRatios;
      double w = std::exp(-0.5 * sigmas * sigmas) * std::pow(p, prior.a - 1) * std::pow(1 - p, prior.b - 1);
      for (const double density : densities) w *= p * density + (1 - p) / prior.z_range;
      sum += w;
      z_sum += w * z;
      zz_sum += w * z * z;
      p_sum += w * p;
      pp_sum += w * p * p;
    }
  }
  const double mean = z_sum / sum, ratio = p_sum / sum;
  return {mean, std::sqrt(zz_sum / sum - mean * mean), ratio, std::sqrt(pp_sum / sum - ratio * ratio)};
}

TEST(DepthFilter, OneUpdateMatchesTheMomentsOfThePosterior) {
  const Seed prior{.a = 12, .b = 7, .mu = 0.12, .z_range = 0.4, .sigma2 = 0.02 * 0.02};
  for (const double x : {0.12, 0.15, 0.19, 0.35}) {
    for (const double tau : {0.005, 0.03, 0.2}) {
      Seed seed = prior;
      UpdateSeed(x, tau, &seed);
      const Posterior ours = Approximate(seed), exact = Exact(prior, {{x, tau}});
      EXPECT_NEAR(ours.mean, exact.mean, 1e-8) << x << " " << tau;
      EXPECT_NEAR(ours.sigma, exact.sigma, 1e-8) << x << " " << tau;
      EXPECT_NEAR(ours.ratio, exact.ratio, 1e-8) << x << " " << tau;
      EXPECT_NEAR(ours.ratio_sigma, exact.ratio_sigma, 1e-8) << x << " " << tau;
    }
  }
}

TEST(DepthFilter, ManyUpdatesStayNearThePosterior) {
  constexpr int kSeeds = 40;
  const Seed prior{.mu = 0.125, .z_range = 0.5, .sigma2 = 0.5 * 0.5 / 36.0};
  for (const double inlier_ratio : {1.0, 0.9, 0.75, 0.6}) {
    int near = 0;
    double bias = 0.0;
    for (std::uint32_t random_seed = 1; random_seed <= kSeeds; ++random_seed) {
      std::mt19937 random(random_seed);
      std::normal_distribution<double> normal;
      std::uniform_real_distribution<double> uniform(0.0, 1.0);
      const double truth = std::clamp(prior.mu + std::sqrt(prior.sigma2) * normal(random), 0.02, prior.z_range);
      std::vector<Measurement> measurements;
      Seed seed = prior;
      for (int i = 1; i <= 30; ++i) {
        const double tau = 0.06 / i + 0.003;  // the baseline grows
        const bool good = uniform(random) < inlier_ratio;
        measurements.push_back({good ? truth + tau * normal(random) : prior.z_range * uniform(random), tau});
        UpdateSeed(measurements.back().x, tau, &seed);
      }
      const Posterior ours = Approximate(seed), exact = Exact(prior, measurements);
      const double off = (ours.mean - exact.mean) / exact.sigma, wider = ours.sigma / exact.sigma;
      bias += off / kSeeds;
      near += std::abs(off) < 0.3 && std::abs(wider - 1.0) < 0.15 && std::abs(ours.ratio - exact.ratio) < 0.05 ? 1 : 0;
    }
    // A few seeds follow a chance cluster of outliers for a while.
    EXPECT_GE(near, inlier_ratio > 0.7 ? kSeeds - 2 : kSeeds - 10) << inlier_ratio;
    EXPECT_NEAR(bias, 0.0, 0.1) << inlier_ratio;
  }
}

TEST(DepthFilter, ConvergesToTheTrueDepthAndReportsItOnce) {
  const Eigen::Vector3d point(0.7, -0.3, 5.0);
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 0.4);
  std::vector<Seed> converged;
  DepthFilter filter({.pixel_noise = 0.5, .convergence = 100}, kPixelAngle,
                     [&](const Seed& s) { converged.push_back(s); });
  filter.AddSeed(Observe(7, point), 0, 8.0, 1.0);
  filter.AddSeed(Observe(7, point), 0, 2.0, 1.0);  // the track has a seed already
  ASSERT_EQ(filter.seeds().size(), 1u);
  for (int i = 1; i < 20; ++i) {
    const Frame frame{0, {}, {Observe(7, Sideways(i) * point, {noise(random), noise(random)})}};
    filter.Update(frame, [&](int) { return Sideways(i); });
  }
  ASSERT_EQ(converged.size(), 1u);
  EXPECT_FALSE(filter.Has(7));
  EXPECT_NEAR(1.0 / converged[0].mu, point.norm(), 0.05 * point.norm());
  EXPECT_LT(std::sqrt(converged[0].sigma2), 0.01);
}

TEST(DepthFilter, DropsATrackOnAMovingObject) {
  int converged = 0;
  DepthFilter filter({}, kPixelAngle, [&](const Seed&) { ++converged; });
  Eigen::Vector3d point(0.7, -0.3, 5.0);
  filter.AddSeed(Observe(1, point), 0, 5.0, 1.0);
  for (int i = 1; i < 30; ++i) {
    point.y() += 0.2;  // across the epipolar line
    filter.Update({0, {}, {Observe(1, Sideways(i) * point)}}, [&](int) { return Sideways(i); });
  }
  EXPECT_EQ(converged, 0);
  EXPECT_TRUE(filter.seeds().empty());
}

TEST(DepthFilter, DoesNotConvergeWithoutMotion) {
  int converged = 0;
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 0.3);
  DepthFilter filter({}, kPixelAngle, [&](const Seed&) { ++converged; });
  const Eigen::Vector3d point(0.7, -0.3, 5.0);
  filter.AddSeed(Observe(1, point), 0, 5.0, 1.0);
  for (int i = 1; i < 200; ++i) {
    filter.Update({0, {}, {Observe(1, point, {noise(random), noise(random)})}}, [](int) { return geometry::SE3(); });
  }
  EXPECT_EQ(converged, 0);
}

TEST(DepthFilter, DropsOldSeeds) {
  DepthFilter filter({.max_age = 3}, kPixelAngle, [](const Seed&) {});
  filter.AddSeed(Observe(1, {0, 0, 5}), 2, 5.0, 1.0);
  filter.DropOld(5);
  EXPECT_TRUE(filter.Has(1));
  filter.DropOld(6);
  EXPECT_FALSE(filter.Has(1));
}

}  // namespace
}  // namespace evo::odometry
