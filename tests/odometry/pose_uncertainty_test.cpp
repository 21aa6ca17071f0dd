#include "odometry/uncertainty/pose_uncertainty.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <random>
#include <tuple>
#include <utility>
#include <vector>

#include "evo/core/median.hpp"
#include "odometry/bundle_drive.hpp"

namespace evo::odometry {
namespace {

using testing::DriveBundle;
using testing::LetTracksDrift;

constexpr CovarianceOptions kIndependent{.variance_inflation = 1.0, .rotation_bias_ratio = 0.0};

/// Mean squared error of the poses over what their covariances say, for one degree of freedom: 1 if they are honest.
double NormalizedError(double noise_px, double drift_px, double expected_drift, std::uint32_t seed) {
  const auto truth = DriveBundle(40, 500, 0.0, seed);
  auto problem = DriveBundle(40, 500, noise_px, seed);
  problem.fixed_frames = 2;
  LetTracksDrift(drift_px, seed, &problem);
  const BundleOptions options{.iterations = 30, .loss_px = 1.0, .drift = expected_drift};
  AdjustBundle(options, &problem);
  const auto covariances = PoseUncertainty(kIndependent, options, problem).Covariances(0, false);
  EXPECT_EQ(covariances.front().norm(), 0.0) << "it is fixed";
  double sum = 0.0;
  for (std::size_t i = 2; i < truth.T_cam_world.size(); ++i) {
    const geometry::Vector6d error = (problem.T_cam_world[i] * truth.T_cam_world[i].Inverse()).Log();
    sum += error.dot(covariances[i].ldlt().solve(error)) / 6.0;
  }
  return sum / static_cast<double>(truth.T_cam_world.size() - 2);
}

double MeanNormalizedError(double noise_px, double drift_px, double expected_drift) {
  double sum = 0.0;
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    sum += NormalizedError(noise_px, drift_px, expected_drift, seed) / 10.0;
  }
  return sum;
}

TEST(PoseUncertainty, CovariancesAreHonest) {
  // The bounds leave room for the scatter of ten drives whose poses err together; half or twice the standard deviation
  // would be far outside.
  for (const auto& [noise_px, drift_px, expected_drift] :
       {std::array{0.3, 0.0, 0.0}, std::array{0.2, 0.2, 1.0}, std::array{0.2, 0.2, 0.0}}) {
    const double normalized = MeanNormalizedError(noise_px, drift_px, expected_drift);
    EXPECT_GT(normalized, 0.5) << noise_px << " " << drift_px;
    EXPECT_LT(normalized, 2.0) << noise_px << " " << drift_px;
  }
}

/// The same for positions whose scale is free, held by a frame and then fitted to the truth.
double NormalizedErrorWithFreeScale(std::uint32_t seed) {
  const auto truth = DriveBundle(40, 500, 0.0, seed);
  auto problem = DriveBundle(40, 500, 0.3, seed);
  problem.scale_frame = 39;
  const BundleOptions options{.iterations = 30, .loss_px = 1.0};
  AdjustBundle(options, &problem);
  const auto covariances = PoseUncertainty(kIndependent, options, problem).Covariances(0, true);
  const auto centre = [](const geometry::SE3& T_cam_world) { return T_cam_world.Inverse().translation(); };
  double products = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < truth.T_cam_world.size(); ++i) {
    products += centre(truth.T_cam_world[i]).dot(centre(problem.T_cam_world[i]));
    squares += centre(truth.T_cam_world[i]).squaredNorm();
  }
  double sum = 0.0;
  for (std::size_t i = 1; i < truth.T_cam_world.size(); ++i) {
    const geometry::SE3& pose = problem.T_cam_world[i];
    const Eigen::Vector3d error =
        pose.RotationMatrix() * (centre(pose) - products / squares * centre(truth.T_cam_world[i]));
    sum += error.dot(covariances[i].topLeftCorner<3, 3>().ldlt().solve(error)) / 3.0;
  }
  return sum / static_cast<double>(truth.T_cam_world.size() - 1);
}

TEST(PoseUncertainty, CovariancesOfAFreeScaleAreHonest) {
  double mean = 0.0;
  for (std::uint32_t seed = 1; seed <= 10; ++seed) mean += NormalizedErrorWithFreeScale(seed) / 10.0;
  EXPECT_GT(mean, 0.5);
  EXPECT_LT(mean, 2.0);
}

TEST(PoseUncertainty, PointsNeedNotBeAtRest) {
  auto problem = DriveBundle(40, 500, 0.3, 3);
  problem.fixed_frames = 2;
  AdjustBundle({.iterations = 30}, &problem);
  const double at_rest = PoseUncertainty({}, {}, problem).Turn(0, 39);
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0.0, 0.0005);
  for (auto& point : problem.points) point.inverse_depth.head<2>() += Eigen::Vector2d(normal(random), normal(random));
  EXPECT_NEAR(PoseUncertainty({}, {}, problem).Turn(0, 39), at_rest, 0.15 * at_rest);
}

TEST(PoseUncertainty, TracksThatErrAlikeTellLess) {
  auto problem = DriveBundle(40, 500, 0.3, 1);
  problem.fixed_frames = 2;
  AdjustBundle({}, &problem);
  EXPECT_NEAR(PoseUncertainty({.variance_inflation = 4.0, .rotation_bias_ratio = 0.0}, {}, problem).Turn(0, 39),
              2.0 * PoseUncertainty(kIndependent, {}, problem).Turn(0, 39), 1e-9);
}

TEST(PoseUncertainty, WhatTurnsTheWholeImageTurnsThePath) {
  // Nearly without noise, and every track turned by a share of the images' motion since it was born.
  constexpr double kShare = 0.02;
  const CovarianceOptions common{.variance_inflation = 1.0, .rotation_bias_ratio = kShare};
  const auto truth = DriveBundle(40, 2000, 0.0, 4);
  auto problem = DriveBundle(40, 2000, 1e-4, 4);
  problem.fixed_frames = 2;
  std::vector<std::vector<double>> motion(40);
  for (std::size_t i = 1; i < problem.observations.size(); ++i) {
    const auto& [before, here] = std::tie(problem.observations[i - 1], problem.observations[i]);
    if (before.point != here.point) continue;
    motion[here.frame].push_back(std::acos(here.x.homogeneous().normalized().dot(before.x.homogeneous().normalized())));
  }
  std::vector<double> turned(40);
  for (std::size_t i = 2; i < 40; ++i) {
    turned[i] = turned[i - 1] + kShare * Median(motion[i]);
  }
  for (auto& observation : problem.observations) {
    const double since_birth = turned[observation.frame] - turned[problem.points[observation.point].anchor];
    const Eigen::Vector3d angle = since_birth * Eigen::Vector3d(1.0, -1.0, 1.0);
    observation.x = (geometry::so3::Exp(angle) * observation.x.homogeneous()).hnormalized();
  }
  AdjustBundle({.iterations = 30}, &problem);
  const auto covariances = PoseUncertainty(common, {}, problem).Covariances(0, false);
  const geometry::Vector6d error = (problem.T_cam_world[39] * truth.T_cam_world[39].Inverse()).Log();
  // Each axis has turned by about its standard deviation.
  for (int k = 3; k < 6; ++k) {
    EXPECT_NEAR(std::abs(error[k]), std::sqrt(covariances[39](k, k)), 0.3 * std::abs(error[k])) << k;
  }
  // The path has bent with it.
  for (int k = 0; k < 2; ++k) {
    EXPECT_LT(std::abs(error[k]), 3.0 * std::sqrt(covariances[39](k, k))) << k;
    EXPECT_GT(std::abs(error[k]), 0.2 * std::sqrt(covariances[39](k, k))) << k;
  }
}

TEST(PoseUncertainty, AScaleFromElsewhereReplacesTheTracks) {
  auto problem = DriveBundle(40, 500, 0.3, 5);
  problem.fixed_frames = 2;
  AdjustBundle({}, &problem);
  PoseUncertainty uncertainty({}, {}, problem);
  const auto by_tracks = uncertainty.Covariances(0, false);
  // Twice as large from now on.
  std::vector<geometry::SE3> poses;
  for (const geometry::SE3& pose : problem.T_cam_world) poses.emplace_back(pose.rotation(), 2.0 * pose.translation());
  constexpr double kError = 0.01;
  constexpr double kReach = 4.0;
  uncertainty.HoldScale(poses, kError, kReach);
  const auto held = uncertainty.Covariances(0, false);
  const double way = (poses[39].Inverse().translation() - poses[0].Inverse().translation()).norm();
  // The scale errs independently after each reach, so the way by the root of their number, twice: its correlation falls
  // exponentially to both sides.
  const double expected = kError * std::sqrt(2.0 * kReach * way);
  const Eigen::Vector3d along = (poses[39] * poses[0].Inverse()).translation().normalized();
  const auto deviation = [](const geometry::Matrix6d& covariance, const Eigen::Vector3d& direction) {
    return std::sqrt(direction.dot(covariance.topLeftCorner<3, 3>() * direction));
  };
  EXPECT_NEAR(deviation(held[39], along), expected, 0.3 * expected);
  EXPECT_GT(deviation(by_tracks[39], along), expected) << "else nothing was gained";
  // Upwards, out of the plane of the bend, the scale has no say.
  const Eigen::Vector3d up = Eigen::Vector3d::UnitY();
  EXPECT_NEAR(deviation(held[39], up), 2.0 * deviation(by_tracks[39], up), 0.1 * deviation(held[39], up));
  EXPECT_EQ((held[39].bottomRightCorner<3, 3>() - by_tracks[39].bottomRightCorner<3, 3>()).norm(), 0.0);
}

TEST(PoseUncertainty, CovariancesAreRelativeToAnyPose) {
  auto problem = DriveBundle(40, 500, 0.3, 1);
  problem.fixed_frames = 2;
  AdjustBundle({}, &problem);
  const PoseUncertainty uncertainty({}, {}, problem);
  const auto from_first = uncertainty.Covariances(0, false);
  const auto from_last = uncertainty.Covariances(39, false);
  EXPECT_LT(from_last[39].norm(), 1e-12);
  // The turn between two poses does not depend on where it is seen from.
  EXPECT_NEAR(std::sqrt(from_first[39].bottomRightCorner<3, 3>().trace()), uncertainty.Turn(0, 39), 1e-9);
  EXPECT_NEAR(std::sqrt(from_last[0].bottomRightCorner<3, 3>().trace()), uncertainty.Turn(0, 39), 1e-9);
}

TEST(PoseUncertainty, EndsOfFewBadTracksAreNotCertain) {
  auto problem = DriveBundle(200, 4000, 0.3, 2);
  const auto stretch = [&] {
    problem.fixed_frames = 2;
    AdjustBundle({}, &problem);
    return PoseUncertainty({}, {}, problem).CertainStretch();
  };
  EXPECT_EQ(stretch(), std::pair(std::size_t{0}, std::size_t{200}));
  const auto at_an_end = [](const BundleObservation& o) { return o.frame < 8 || o.frame >= 190; };
  std::erase_if(problem.observations, [&](const auto& o) { return at_an_end(o) && o.point % 10 != 0; });
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0.0, 2.0 / 226.0);
  for (auto& o : problem.observations) {
    if (at_an_end(o)) o.x += Eigen::Vector2d(normal(random), normal(random));
  }
  const auto [begin, end] = stretch();
  EXPECT_GE(begin, 3u);
  EXPECT_LE(begin, 12u);
  EXPECT_LE(end, 197u);
  EXPECT_GE(end, 185u);
}

}  // namespace
}  // namespace evo::odometry
