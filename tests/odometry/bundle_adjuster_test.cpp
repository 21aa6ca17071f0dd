#include "odometry/bundle/bundle_adjuster.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <utility>

#include "odometry/bundle/track_weights.hpp"
#include "odometry/bundle_drive.hpp"
#include "odometry/uncertainty/pose_uncertainty.hpp"

namespace evo::odometry {
namespace {

using testing::AddTrackDrift;
using testing::DriveBundle;

void Perturb(BundleProblem* problem, double by) {
  std::mt19937 random(9);
  std::normal_distribution<double> normal(0.0, by);
  for (std::size_t i = problem->fixed_frames; i < problem->T_cam_world.size(); ++i) {
    geometry::Vector6d xi;
    for (int k = 0; k < 6; ++k) xi[k] = (k < 3 ? 1.0 : 0.1) * normal(random);
    problem->T_cam_world[i] = geometry::SE3::Exp(xi) * problem->T_cam_world[i];
  }
  for (auto& point : problem->points) point.inverse_depth.z() *= std::exp(5 * normal(random));
}

TEST(BundleAdjuster, RecoversTheTruthWithoutNoise) {
  const auto truth = DriveBundle(12, 120, 0.0, 2);
  auto problem = truth;
  problem.fixed_frames = 2;  // the scale is held
  Perturb(&problem, 0.05);
  const auto summary = AdjustBundle({.max_iterations = 50, .min_relative_decrease = 1e-12}, &problem);
  EXPECT_LT(summary.final_cost, 1e-8);
  EXPECT_LT(summary.final_cost, 1e-6 * summary.initial_cost);
  for (std::size_t i = 0; i < truth.T_cam_world.size(); ++i) {
    EXPECT_LT((problem.T_cam_world[i] * truth.T_cam_world[i].Inverse()).Log().norm(), 1e-5) << i;
  }
}

TEST(BundleAdjuster, ConvergesWithFreeScale) {
  auto problem = DriveBundle(12, 120, 0.0, 3);
  Perturb(&problem, 0.05);
  const auto summary = AdjustBundle({.max_iterations = 50, .min_relative_decrease = 1e-12}, &problem);
  EXPECT_LT(summary.final_cost, 1e-8);
}

/// Root mean square error of the poses' rotations, rad.
double RotationError(const BundleProblem& problem, const BundleProblem& truth) {
  double sum = 0.0;
  for (std::size_t i = 0; i < truth.T_cam_world.size(); ++i) {
    sum += (problem.T_cam_world[i] * truth.T_cam_world[i].Inverse()).Log().tail<3>().squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(truth.T_cam_world.size()));
}

/// The same after an adjustment with this drift model.
double RotationError(double drift, std::uint32_t seed) {
  const auto truth = DriveBundle(40, 500, 0.0, seed);
  auto problem = DriveBundle(40, 500, 0.1, seed);
  problem.fixed_frames = 2;
  AddTrackDrift(0.3, seed, &problem);
  AdjustBundle({.max_iterations = 30, .cauchy_width_px = 100.0, .drift_variance_ratio = drift}, &problem);
  return RotationError(problem, truth);
}

TEST(BundleAdjuster, DriftModelReducesTheErrorWhereTracksDrift) {
  double with = 0.0, without = 0.0;
  for (std::uint32_t seed = 1; seed <= 12; ++seed) {
    with += RotationError(9.0, seed);
    without += RotationError(0.0, seed);
  }
  EXPECT_LT(with, 0.9 * without);
}

TEST(BundleAdjuster, DriftModelConvergesToAMinimum) {
  auto problem = DriveBundle(10, 60, 0.5, 6);
  problem.fixed_frames = 2;
  const BundleOptions options{.max_iterations = 100, .drift_variance_ratio = 0.4, .min_relative_decrease = 1e-14};
  // The magnifications are those of the start, so from there once more.
  for (int i = 0; i < 5; ++i) AdjustBundle(options, &problem);
  const auto cost = [&](const BundleProblem& at) {
    auto copy = at;
    return AdjustBundle({.max_iterations = 0, .drift_variance_ratio = 0.4}, &copy).initial_cost;
  };
  const double least = cost(problem);
  for (std::size_t i = 2; i < problem.T_cam_world.size(); ++i) {
    for (int k = 0; k < 6; ++k) {
      for (const double h : {1e-3, -1e-3}) {
        auto moved = problem;
        moved.T_cam_world[i] = geometry::SE3::Exp(h * geometry::Vector6d::Unit(k)) * moved.T_cam_world[i];
        EXPECT_GT(cost(moved), least) << i << " " << k;
      }
    }
  }
}

/// The points in order of their first frames, as in a run: only so can threads share the work.
BundleProblem InOrderOfFrames(BundleProblem problem) {
  std::ranges::stable_sort(problem.observations, {}, [&](const BundleObservation& observation) {
    return std::pair(problem.points[observation.point].anchor, observation.point);
  });
  std::vector<BundlePoint> points;
  int last = -1;
  for (auto& observation : problem.observations) {
    if (observation.point != last) points.push_back(problem.points[observation.point]);
    last = observation.point;
    observation.point = static_cast<int>(points.size()) - 1;
  }
  problem.points = points;
  return problem;
}

TEST(BundleAdjuster, ResultDoesNotDependOnThreads) {
  auto start = InOrderOfFrames(DriveBundle(150, 1500, 0.3, 7));
  start.fixed_frames = 2;
  Perturb(&start, 0.002);
  const BundleOptions options{.max_iterations = 4, .drift_variance_ratio = 0.1};
  auto alone = start;
  AdjustBundle(options, &alone);
  const auto alone_covariances = EstimatePoseUncertainty({}, options, alone)->errors.Covariances(0, true);
  for (const int threads : {1, 2, 4}) {
    ThreadPool pool(threads);
    auto together = start;
    AdjustBundle(options, &together, &pool);
    const auto covariances = EstimatePoseUncertainty({}, options, together, &pool)->errors.Covariances(0, true);
    for (std::size_t i = 0; i < alone.T_cam_world.size(); ++i) {
      EXPECT_EQ(alone.T_cam_world[i].Matrix(), together.T_cam_world[i].Matrix()) << threads << " " << i;
      EXPECT_EQ(alone_covariances[i], covariances[i]) << threads << " " << i;
    }
    for (std::size_t p = 0; p < alone.points.size(); ++p) {
      EXPECT_EQ(alone.points[p].inverse_depth, together.points[p].inverse_depth) << threads << " " << p;
    }
  }
}

/// A pose seen by a few tracks, one of which has slipped.
TEST(BundleAdjuster, MotionPriorHoldsAPoseWithFewTracks) {
  constexpr int kFrame = 6;
  double with = 0.0, without = 0.0;  // maximum errors
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    auto truth = DriveBundle(12, 120, 0.2, seed);
    truth.fixed_frames = 2;
    int seen = 0;
    std::erase_if(truth.observations, [&](const BundleObservation& o) { return o.frame == kFrame && ++seen > 5; });
    std::ranges::find(truth.observations, kFrame, &BundleObservation::frame)->x.x() += 4.0 / 226.0;
    const auto error_of = [&](const MotionPrior& motion) {
      auto problem = truth;
      problem.motion = motion;
      Perturb(&problem, 0.01);
      AdjustBundle({.max_iterations = 50, .cauchy_width_px = 0.5}, &problem);
      return (problem.T_cam_world[kFrame] * truth.T_cam_world[kFrame].Inverse()).Log().norm();
    };
    MotionPrior motion{{}, 0.2, 2.0};
    for (int i = 0; i < 12; ++i) motion.times_s.push_back(0.02 * i);
    with = std::max(with, error_of(motion));
    without = std::max(without, error_of({}));
  }
  EXPECT_LT(with, 0.03);
  EXPECT_GT(without, 0.1);
}

/// A drive with every other track eight times as noisy as the others.
BundleProblem DriveWithNoisyTracks(std::uint32_t seed) {
  auto problem = DriveBundle(40, 500, 0.1, seed);
  problem.fixed_frames = 2;
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, 0.8 / 226.0);
  for (auto& o : problem.observations) {
    if (o.point % 2 == 0) o.x += Eigen::Vector2d(normal(random), normal(random));
  }
  return problem;
}

TEST(BundleAdjuster, TrackWeightsFollowTheTracksNoise) {
  auto problem = DriveWithNoisyTracks(1);
  SetTrackWeights(0.0, &problem);
  std::array<std::vector<double>, 2> weights;
  for (std::size_t p = 0; p < problem.points.size(); ++p) weights[p % 2].push_back(problem.points[p].weight);
  for (auto& group : weights) std::ranges::sort(group);
  const double ratio = weights[1][weights[1].size() / 2] / weights[0][weights[0].size() / 2];
  EXPECT_GT(ratio, 2.0);  // the prior draws both towards the typical noise
  EXPECT_LT(ratio, 8.1);
  EXPECT_GT(weights[1].front(), weights[0].back());
  const auto weighted = problem;
  SetTrackWeights(0.0, &problem);
  for (std::size_t p = 0; p < problem.points.size(); ++p) {
    EXPECT_EQ(problem.points[p].weight, weighted.points[p].weight);
  }
}

TEST(BundleAdjuster, TrackWeightsReduceTheErrorWhereNoiseDiffers) {
  const auto rotation_error = [](bool use_weights, std::uint32_t seed) {
    const auto truth = DriveBundle(40, 500, 0.0, seed);
    auto problem = DriveWithNoisyTracks(seed);
    const BundleOptions options{.max_iterations = 30, .cauchy_width_px = 100.0};
    AdjustBundle(options, &problem);
    if (use_weights) {
      SetTrackWeights(0.0, &problem);
      AdjustBundle(options, &problem);
    }
    return std::pow(RotationError(problem, truth), 2);
  };
  double with = 0.0, without = 0.0;
  for (std::uint32_t seed = 1; seed <= 8; ++seed) {
    with += rotation_error(true, seed);
    without += rotation_error(false, seed);
  }
  EXPECT_LT(std::sqrt(with), 0.5 * std::sqrt(without));
}

TEST(BundleAdjuster, IsRobustToOutliers) {
  const auto truth = DriveBundle(12, 200, 0.0, 4);
  auto problem = DriveBundle(12, 200, 0.3, 4);
  problem.fixed_frames = 2;
  for (std::size_t i = 0; i < problem.observations.size(); i += 12) problem.observations[i].x.x() += 0.1;
  AdjustBundle({.max_iterations = 50}, &problem);
  const geometry::Vector6d error = (problem.T_cam_world.back() * truth.T_cam_world.back().Inverse()).Log();
  EXPECT_LT(error.head<3>().norm(), 0.1);
  EXPECT_LT(error.tail<3>().norm(), 0.005);
}

}  // namespace
}  // namespace evo::odometry
