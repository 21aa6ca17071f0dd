#include <ceres/ceres.h>
#include <ceres/rotation.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "odometry/bundle/bundle_adjuster.hpp"
#include "odometry/track_covariance.hpp"

namespace evo::odometry {
namespace {

constexpr int kFrames = 6;
constexpr double kCauchyWidthPx = 1.0;
constexpr double kScaleWeightPx = 1e3;  // any: it fixes what the observations leave free

/// Observations with noise and some outliers by a camera that drives forward; poses and points are perturbed.
BundleProblem PerturbedDrive(std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> side(-0.6, 0.6), depth(4.0, 20.0), uniform(0.0, 1.0), far(-15.0, 15.0);
  std::normal_distribution<double> normal;
  BundleProblem problem;
  for (int i = 0; i < kFrames; ++i) {
    problem.T_cam_world.emplace_back(geometry::so3::Exp({0.01 * i, -0.02 * i, 0.005 * i}),
                                     Eigen::Vector3d(0.05 * i, 0.0, -0.5 * i));
  }
  for (int p = 0; p < 40; ++p) {
    problem.points.push_back({p % 3, {side(random), side(random), 1.0 / depth(random)}, 0.7 + 0.2 * (p % 4)});
    for (int i = p % 3; i < kFrames; ++i) {
      const Eigen::Vector3d q = problem.T_cam_world[i] * WorldPosition(problem, problem.points.back());
      Eigen::Vector2d error_px(0.4 * normal(random), 0.4 * normal(random));
      if (uniform(random) < 0.08) error_px += Eigen::Vector2d(far(random), far(random));
      Eigen::Matrix2d J_pixel_normalized;
      J_pixel_normalized << 230.0 + 10.0 * normal(random), 5.0 * normal(random), 5.0 * normal(random), 210.0;
      problem.observations.push_back(
          {i, p, q.head<2>() / q.z() + J_pixel_normalized.inverse() * error_px, J_pixel_normalized});
    }
  }
  for (int i = 2; i < kFrames; ++i) {
    geometry::Vector6d twist;
    for (int k = 0; k < 6; ++k) twist[k] = (k < 3 ? 0.03 : 0.003) * normal(random);
    problem.T_cam_world[i] = geometry::SE3::Exp(twist) * problem.T_cam_world[i];
  }
  for (auto& point : problem.points) point.inverse_depth.z() *= std::exp(0.1 * normal(random));
  return problem;
}

/// The weighted sum of the errors of one track; the parameters are its point and then all poses T_cam_world as axis
/// times angle and translation.
struct Innovation {
  const BundleProblem& problem;
  std::size_t first;  // observation
  Eigen::VectorXd weights;

  template <typename T>
  bool operator()(const T* const* parameters, T* residual) const {
    Eigen::Map<Eigen::Matrix<T, 2, 1>> sum(residual);
    sum.setZero();
    for (Eigen::Index k = 0; k < weights.size(); ++k) {
      const BundleObservation& observation = problem.observations[first + static_cast<std::size_t>(k)];
      const T* const anchor = parameters[1 + problem.points[observation.point].anchor];
      const T* const camera = parameters[1 + observation.frame];
      const T* const point = parameters[0];
      const T back[3] = {-anchor[0], -anchor[1], -anchor[2]};
      const T centred[3] = {point[0] / point[2] - anchor[3], point[1] / point[2] - anchor[4],
                            1.0 / point[2] - anchor[5]};
      T world[3], rotated[3];
      ceres::AngleAxisRotatePoint(back, centred, world);
      ceres::AngleAxisRotatePoint(camera, world, rotated);
      const T z = rotated[2] + camera[5];
      const Eigen::Matrix<T, 2, 1> projection((rotated[0] + camera[3]) / z, (rotated[1] + camera[4]) / z);
      sum += weights[k] * (observation.J_pixel_normalized * (observation.x - projection));
    }
    return true;
  }
};

struct HeldDistance {
  double length;

  template <typename T>
  bool operator()(const T* pose, T* residual) const {
    residual[0] = kScaleWeightPx * (Eigen::Map<const Eigen::Matrix<T, 3, 1>>(pose + 3).norm() / length - 1.0);
    return true;
  }
};

/// The matrix that takes the errors of the observations [first, end) of one track to normalised innovations: the
/// inverse Cholesky factor of their covariance, in units of an innovation late in a track.
Eigen::MatrixXd WhiteningMatrix(const BundleProblem& problem, double drift, std::size_t first, std::size_t end) {
  std::vector<double> magnifications;
  for (std::size_t i = first; i < end; ++i) {
    const BundlePoint& point = problem.points[problem.observations[i].point];
    const Eigen::Vector3d q = problem.T_cam_world[problem.observations[i].frame] * WorldPosition(problem, point);
    magnifications.push_back(1.0 / (q.z() * point.inverse_depth.z()));
  }
  const Eigen::MatrixXd factor = testing::TrackCovariance(drift, magnifications).llt().matrixL();
  const double steady_variance = 0.5 * (drift + std::sqrt(drift * drift + 4.0 * drift));
  return problem.points[problem.observations[first].point].weight * std::sqrt(1.0 + steady_variance) * factor.inverse();
}

/// Adds a residual with a loss for every observation of one track.
void AddTrack(const BundleProblem& start, double drift, std::size_t first, std::size_t end,
              const std::vector<double*>& parameters, ceres::Problem* ceres) {
  const Eigen::MatrixXd whitening = WhiteningMatrix(start, drift, first, end);
  for (Eigen::Index k = 0; k < whitening.rows(); ++k) {
    auto* const cost =
        new ceres::DynamicAutoDiffCostFunction<Innovation>(new Innovation{start, first, whitening.row(k).head(k + 1)});
    cost->AddParameterBlock(3);
    for (int i = 0; i < kFrames; ++i) cost->AddParameterBlock(6);
    cost->SetNumResiduals(2);
    ceres->AddResidualBlock(cost, new ceres::CauchyLoss(kCauchyWidthPx), parameters);
  }
}

/// AdjustBundle by Ceres and its automatic derivatives; returns the cost.
double AdjustByCeres(double drift, BundleProblem* problem) {
  const BundleProblem start = *problem;
  std::vector<geometry::Vector6d> poses(kFrames);
  ceres::Problem ceres;
  for (int i = 0; i < kFrames; ++i) {
    poses[i] << geometry::so3::Log(start.T_cam_world[i].rotation()), start.T_cam_world[i].translation();
    ceres.AddParameterBlock(poses[i].data(), 6);
    if (i < start.fixed_frames) ceres.SetParameterBlockConstant(poses[i].data());
  }
  for (std::size_t first = 0, end = 0; first < start.observations.size(); first = end) {
    const int point = start.observations[first].point;
    while (end < start.observations.size() && start.observations[end].point == point) ++end;
    std::vector<double*> parameters = {problem->points[point].inverse_depth.data()};
    for (auto& pose : poses) parameters.push_back(pose.data());
    AddTrack(start, drift, first, end, parameters, &ceres);
  }
  if (start.scale_frame >= 0) {
    const double length = start.T_cam_world[start.scale_frame].translation().norm();
    ceres.AddResidualBlock(new ceres::AutoDiffCostFunction<HeldDistance, 1, 6>(new HeldDistance{length}), nullptr,
                           poses[start.scale_frame].data());
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 300;
  options.function_tolerance = 1e-15;
  options.gradient_tolerance = 1e-12;
  options.parameter_tolerance = 1e-14;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &ceres, &summary);
  EXPECT_EQ(summary.termination_type, ceres::CONVERGENCE) << summary.message;
  for (int i = 0; i < kFrames; ++i) {
    problem->T_cam_world[i] = geometry::SE3(geometry::so3::Exp(poses[i].head<3>()), poses[i].tail<3>());
  }
  return summary.final_cost;
}

double MaxPoseDifference(const BundleProblem& a, const BundleProblem& b) {
  double max = 0.0;
  for (int i = 0; i < kFrames; ++i) {
    max = std::max(max, (a.T_cam_world[i] * b.T_cam_world[i].Inverse()).Log().norm());
  }
  return max;
}

void ExpectSameMinimum(double drift, int fixed_frames, int scale_frame) {
  for (std::uint32_t seed = 2; seed <= 4; ++seed) {
    auto start = PerturbedDrive(seed);
    start.fixed_frames = fixed_frames;
    start.scale_frame = scale_frame;
    auto ours = start;
    auto theirs = start;
    const BundleSummary summary = AdjustBundle({.max_iterations = 300,
                                                .cauchy_width_px = kCauchyWidthPx,
                                                .drift_variance_ratio = drift,
                                                .min_relative_decrease = 1e-15},
                                               &ours);
    const double cost = AdjustByCeres(drift, &theirs);
    EXPECT_LT(summary.final_cost, 0.6 * summary.initial_cost) << seed;
    EXPECT_GT(MaxPoseDifference(ours, start), 0.02) << seed;
    EXPECT_NEAR(summary.final_cost, cost, 1e-10 * cost) << seed;
    EXPECT_LT(MaxPoseDifference(ours, theirs), 1e-6) << seed;
    for (std::size_t p = 0; p < ours.points.size(); ++p) {
      EXPECT_LT((ours.points[p].inverse_depth - theirs.points[p].inverse_depth).norm(), 1e-6) << seed << " " << p;
    }
  }
}

TEST(BundleByCeres, HasSameMinimum) { ExpectSameMinimum(0.0, 2, -1); }

TEST(BundleByCeres, HasSameMinimumWithAScaleFrame) { ExpectSameMinimum(0.0, 1, kFrames - 1); }

TEST(BundleByCeres, HasSameMinimumWithDrift) { ExpectSameMinimum(0.5, 2, -1); }

}  // namespace
}  // namespace evo::odometry
