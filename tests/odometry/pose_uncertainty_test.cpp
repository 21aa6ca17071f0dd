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
#include "odometry/uncertainty/scale_information.hpp"

namespace evo::odometry {
namespace {

using testing::AddTrackDrift;
using testing::DriveBundle;

constexpr CovarianceOptions kIndependent{.variance_inflation = 1.0, .rotation_bias_ratio = 0.0};

/// Mean squared error of the poses over what their covariances say, for one degree of freedom: 1 if they are right.
double NormalizedError(double noise_px, double drift_px, double expected_drift, std::uint32_t seed) {
  const auto truth = DriveBundle(40, 500, 0.0, seed);
  auto problem = DriveBundle(40, 500, noise_px, seed);
  problem.fixed_frames = 2;
  AddTrackDrift(drift_px, seed, &problem);
  const BundleOptions options{.max_iterations = 30, .cauchy_width_px = 1.0, .drift_variance_ratio = expected_drift};
  AdjustBundle(options, &problem);
  const auto covariances = EstimatePoseUncertainty(kIndependent, options, problem)->errors.Covariances(0, false);
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

TEST(PoseUncertainty, CovariancesMatchTheErrors) {
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
  const BundleOptions options{.max_iterations = 30, .cauchy_width_px = 1.0};
  AdjustBundle(options, &problem);
  const auto covariances = EstimatePoseUncertainty(kIndependent, options, problem)->errors.Covariances(0, true);
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

TEST(PoseUncertainty, CovariancesWithFreeScaleMatchTheErrors) {
  double mean = 0.0;
  for (std::uint32_t seed = 1; seed <= 10; ++seed) mean += NormalizedErrorWithFreeScale(seed) / 10.0;
  EXPECT_GT(mean, 0.5);
  EXPECT_LT(mean, 2.0);
}

TEST(PoseUncertainty, PointsNeedNotBeAtTheirMinimum) {
  auto problem = DriveBundle(40, 500, 0.3, 3);
  problem.fixed_frames = 2;
  AdjustBundle({.max_iterations = 30}, &problem);
  const double at_minimum = EstimatePoseUncertainty({}, {}, problem)->errors.RotationSigma(0, 39);
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0.0, 0.0005);
  for (auto& point : problem.points) point.inverse_depth.head<2>() += Eigen::Vector2d(normal(random), normal(random));
  EXPECT_NEAR(EstimatePoseUncertainty({}, {}, problem)->errors.RotationSigma(0, 39), at_minimum, 0.15 * at_minimum);
}

TEST(PoseUncertainty, VarianceInflationScalesTheVariances) {
  auto problem = DriveBundle(40, 500, 0.3, 1);
  problem.fixed_frames = 2;
  AdjustBundle({}, &problem);
  EXPECT_NEAR(EstimatePoseUncertainty({.variance_inflation = 4.0, .rotation_bias_ratio = 0.0}, {}, problem)
                  ->errors.RotationSigma(0, 39),
              2.0 * EstimatePoseUncertainty(kIndependent, {}, problem)->errors.RotationSigma(0, 39), 1e-9);
}

TEST(PoseUncertainty, RotationBiasRotatesThePath) {
  // Nearly without noise, and every track rotated by a ratio of the image motion since its first observation.
  constexpr double kBiasRatio = 0.02;
  const CovarianceOptions options{.variance_inflation = 1.0, .rotation_bias_ratio = kBiasRatio};
  const auto truth = DriveBundle(40, 2000, 0.0, 4);
  auto problem = DriveBundle(40, 2000, 1e-4, 4);
  problem.fixed_frames = 2;
  std::vector<std::vector<double>> motion(40);
  for (std::size_t i = 1; i < problem.observations.size(); ++i) {
    const auto& [previous, current] = std::tie(problem.observations[i - 1], problem.observations[i]);
    if (previous.point != current.point) continue;
    motion[current.frame].push_back(
        std::acos(current.x.homogeneous().normalized().dot(previous.x.homogeneous().normalized())));
  }
  std::vector<double> rotation(40);
  for (std::size_t i = 2; i < 40; ++i) {
    rotation[i] = rotation[i - 1] + kBiasRatio * Median(motion[i]);
  }
  for (auto& observation : problem.observations) {
    const double since_first = rotation[observation.frame] - rotation[problem.points[observation.point].anchor];
    const Eigen::Vector3d angle = since_first * Eigen::Vector3d(1.0, -1.0, 1.0);
    observation.x = (geometry::so3::Exp(angle) * observation.x.homogeneous()).hnormalized();
  }
  AdjustBundle({.max_iterations = 30}, &problem);
  const auto covariances = EstimatePoseUncertainty(options, {}, problem)->errors.Covariances(0, false);
  const geometry::Vector6d error = (problem.T_cam_world[39] * truth.T_cam_world[39].Inverse()).Log();
  // Each axis has rotated by about its standard deviation.
  for (int k = 3; k < 6; ++k) {
    EXPECT_NEAR(std::abs(error[k]), std::sqrt(covariances[39](k, k)), 0.3 * std::abs(error[k])) << k;
  }
  // The path has rotated with it.
  for (int k = 0; k < 2; ++k) {
    EXPECT_LT(std::abs(error[k]), 3.0 * std::sqrt(covariances[39](k, k))) << k;
    EXPECT_GT(std::abs(error[k]), 0.2 * std::sqrt(covariances[39](k, k))) << k;
  }
}

TEST(PoseUncertainty, ScaleInformationReplacesTheTracks) {
  auto problem = DriveBundle(40, 500, 0.3, 5);
  problem.fixed_frames = 2;
  AdjustBundle({}, &problem);
  PoseErrorSamples errors = EstimatePoseUncertainty({}, {}, problem)->errors;
  const auto by_tracks = errors.Covariances(0, false);
  // Twice as large from now on.
  std::vector<geometry::SE3> poses;
  for (const geometry::SE3& pose : problem.T_cam_world) poses.emplace_back(pose.rotation(), 2.0 * pose.translation());
  constexpr double kSigma = 0.01;
  constexpr double kCorrelationLength = 4.0;
  ApplyScaleInformation({kSigma, kCorrelationLength}, poses, &errors);
  const auto held = errors.Covariances(0, false);
  const double length = (poses[39].Inverse().translation() - poses[0].Inverse().translation()).norm();
  // The variance of the integral of an exponentially correlated process over a long path.
  const double expected = kSigma * std::sqrt(2.0 * kCorrelationLength * length);
  const Eigen::Vector3d along = (poses[39] * poses[0].Inverse()).translation().normalized();
  const auto deviation = [](const geometry::Matrix6d& covariance, const Eigen::Vector3d& direction) {
    return std::sqrt(direction.dot(covariance.topLeftCorner<3, 3>() * direction));
  };
  EXPECT_NEAR(deviation(held[39], along), expected, 0.3 * expected);
  EXPECT_GT(deviation(by_tracks[39], along), expected) << "the information must be the better one";
  // Upwards, out of the plane of the curve, the scale has no effect.
  const Eigen::Vector3d up = Eigen::Vector3d::UnitY();
  EXPECT_NEAR(deviation(held[39], up), 2.0 * deviation(by_tracks[39], up), 0.1 * deviation(held[39], up));
  EXPECT_EQ((held[39].bottomRightCorner<3, 3>() - by_tracks[39].bottomRightCorner<3, 3>()).norm(), 0.0);
}

/// A camera that moves by one unit a pose, with a scale that is a random walk.
TEST(PoseUncertainty, MeasuresTheDriftOfTheScale) {
  constexpr double kDrift = 0.003;
  constexpr std::size_t kPoses = 200;
  constexpr Eigen::Index kSamples = 100;
  std::vector<geometry::SE3> poses;
  for (std::size_t i = 0; i < kPoses; ++i) {
    poses.emplace_back(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, 0, -static_cast<double>(i)));
  }
  PoseErrorSamples errors(poses, kSamples);
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (Eigen::Index k = 0; k < kSamples; ++k) {
    double scale_error = 0.0;
    Eigen::Vector3d error = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < kPoses; ++i) {
      errors.SetCentreError(i, k, error);
      scale_error += kDrift * normal(random);
      error.z() += scale_error;
    }
  }
  for (const double window : {5.0, 10.0, 30.0}) {
    EXPECT_NEAR(EstimateScaleDrift(errors, window), kDrift, 0.1 * kDrift) << window;
  }
  EXPECT_EQ(EstimateScaleDrift(errors, 1000.0), 0.0) << "shorter than the window";
}

TEST(PoseUncertainty, CovariancesAreRelativeToAnyPose) {
  auto problem = DriveBundle(40, 500, 0.3, 1);
  problem.fixed_frames = 2;
  AdjustBundle({}, &problem);
  const PoseErrorSamples errors = EstimatePoseUncertainty({}, {}, problem)->errors;
  const auto from_first = errors.Covariances(0, false);
  const auto from_last = errors.Covariances(39, false);
  EXPECT_LT(from_last[39].norm(), 1e-12);
  // The rotation between two poses does not depend on the origin.
  EXPECT_NEAR(std::sqrt(from_first[39].bottomRightCorner<3, 3>().trace()), errors.RotationSigma(0, 39), 1e-9);
  EXPECT_NEAR(std::sqrt(from_last[0].bottomRightCorner<3, 3>().trace()), errors.RotationSigma(0, 39), 1e-9);
}

TEST(PoseUncertainty, EndsWithFewNoisyTracksAreNotCertain) {
  auto problem = DriveBundle(200, 4000, 0.3, 2);
  const auto certain_range = [&] {
    problem.fixed_frames = 2;
    AdjustBundle({}, &problem);
    return EstimatePoseUncertainty({}, {}, problem)->certain_range;
  };
  const PoseRange whole = certain_range();
  EXPECT_EQ(whole.begin, 0u);
  EXPECT_EQ(whole.end, 200u);
  const auto at_an_end = [](const BundleObservation& o) { return o.frame < 8 || o.frame >= 190; };
  std::erase_if(problem.observations, [&](const auto& o) { return at_an_end(o) && o.point % 10 != 0; });
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0.0, 2.0 / 226.0);
  for (auto& o : problem.observations) {
    if (at_an_end(o)) o.x += Eigen::Vector2d(normal(random), normal(random));
  }
  const auto [begin, end] = certain_range();
  EXPECT_GE(begin, 3u);
  EXPECT_LE(begin, 12u);
  EXPECT_LE(end, 197u);
  EXPECT_GE(end, 185u);
}

}  // namespace
}  // namespace evo::odometry
