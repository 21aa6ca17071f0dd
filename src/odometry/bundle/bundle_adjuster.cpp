#include "odometry/bundle/bundle_adjuster.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "odometry/bundle/linearized_track.hpp"
#include "odometry/bundle/normal_equations.hpp"
#include "odometry/bundle/point_batches.hpp"
#include "odometry/bundle/reprojection.hpp"

namespace evo::odometry {

namespace {

constexpr double kBehindPx = 1e3;  // innovation of a point behind the camera: above any other; constant, no gradient
// Levenberg-Marquardt's lambda: the least one is tiny, because weak gradients bend a long drive and more would hold it.
constexpr double kMinDamping = 1e-12;
constexpr double kMinRetryDamping = 1e-7;  // after a failed step, which a lower one would only repeat
constexpr double kMaxDamping = 1e6;        // beyond it no step decreases the cost
constexpr double kDampingIncrease = 10.0;
constexpr double kDampingDecrease = 0.03;
constexpr std::size_t kPointChunk = 64;  // points handed to a thread at once
// A point's own steps, from a start that is already near.
constexpr int kPointSteps = 3;
constexpr double kPointStepDamping = 1e-3;
constexpr double kPointDampingIncrease = 100.0;
constexpr double kPointDampingDecrease = 0.1;
constexpr double kMinDiagonal = 1e-12;  // keeps a point without parallax from being singular

/// Cauchy's loss of a squared error.
double CauchyCost(double squared, double width) { return 0.5 * width * width * std::log1p(squared / (width * width)); }

/// Cost of the observations [begin, end) of one point.
double PointCost(const BundleProblem& problem, const NoiseModel& noise, std::size_t begin, std::size_t end) {
  thread_local std::vector<Eigen::Vector2d> errors, innovations;
  ComputeTrackErrors(problem, begin, end, &errors);
  ComputeInnovations(noise.Whitening(begin, end), errors, &innovations);
  double cost = 0.0;
  for (const auto& innovation : innovations) {
    cost += CauchyCost(std::min(innovation.squaredNorm(), kBehindPx * kBehindPx), noise.cauchy_width_px);
  }
  return cost;
}

/// Cost of the changes of velocity.
double MotionCost(const BundleProblem& problem, double cauchy_width_px) {
  const MotionPrior& motion = problem.motion;
  double cost = 0.0;
  for (std::size_t i = 1; i + 1 < motion.times_s.size(); ++i) {
    const geometry::Vector6d change = ComputeVelocityChange(problem.T_cam_world, motion.times_s, i);
    cost += CauchyCost((motion.translation_weight_px * change.head<3>()).squaredNorm(), cauchy_width_px) +
            CauchyCost((motion.rotation_weight_px * change.tail<3>()).squaredNorm(), cauchy_width_px);
  }
  return cost;
}

/// A few damped Gauss-Newton steps of one point with the poses fixed; returns its cost.
double RefinePoint(const NoiseModel& noise, std::size_t begin, std::size_t end, BundleProblem* problem) {
  thread_local LinearizedTrack track;
  BundlePoint& point = problem->points[problem->observations[begin].point];
  double cost = PointCost(*problem, noise, begin, end);
  double damping = kPointStepDamping;
  for (int step = 0; step < kPointSteps; ++step) {
    Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    track.Linearize(*problem, noise, begin, end);
    for (std::size_t k = 0; k < end - begin; ++k) {
      const auto weighted = track.ComputeWeightedRow(k);
      hessian.noalias() += track.observation(k).J_error_point.transpose() * weighted.J_error_point;
      gradient.noalias() += track.observation(k).J_error_point.transpose() * weighted.error;
    }
    hessian.diagonal() *= 1.0 + damping;
    hessian.diagonal().array() += kMinDiagonal;
    const Eigen::Vector3d previous = point.inverse_depth;
    point.inverse_depth -= hessian.ldlt().solve(gradient);
    point.inverse_depth.z() = std::max(point.inverse_depth.z(), 0.0);
    const double new_cost = PointCost(*problem, noise, begin, end);
    if (new_cost < cost) {
      cost = new_cost;
      damping *= kPointDampingDecrease;
    } else {
      point.inverse_depth = previous;
      damping *= kPointDampingIncrease;
    }
  }
  return cost;
}

/// Sets the points' costs after a common step; returns the whole cost. A point with a higher cost, far away or nearly
/// on the path, takes the better of its old and new values and is refined alone, lest it reject the step of all others.
double UpdateCosts(const std::vector<BundlePoint>& old_points, const NoiseModel& noise,
                   const std::vector<std::size_t>& begin, ThreadPool* pool, std::vector<double>* costs,
                   BundleProblem* problem) {
  ForEachIndex(pool, costs->size(), kPointChunk, [&](std::size_t p) {
    if (begin[p] == begin[p + 1]) return;
    double cost = PointCost(*problem, noise, begin[p], begin[p + 1]);
    if (cost > (*costs)[p]) {
      const BundlePoint stepped = std::exchange(problem->points[p], old_points[p]);
      if (PointCost(*problem, noise, begin[p], begin[p + 1]) > cost) problem->points[p] = stepped;
      cost = RefinePoint(noise, begin[p], begin[p + 1], problem);
    }
    (*costs)[p] = cost;
  });
  return std::accumulate(costs->begin(), costs->end(), MotionCost(*problem, noise.cauchy_width_px));
}

/// Change of a point's inverse depth when its anchor moves by the left twist and the point stays, to first order.
Eigen::Vector3d ChangeByAnchorMotion(const Eigen::Vector3d& inverse_depth, const geometry::Vector6d& twist) {
  const Eigen::Vector3d ray = inverse_depth.head<2>().homogeneous();
  const Eigen::Vector3d u = inverse_depth.z() * twist.head<3>() + twist.tail<3>().cross(ray);
  return {u.x() - ray.x() * u.z(), u.y() - ray.y() * u.z(), -inverse_depth.z() * u.z()};
}

/// The equations hold the anchors fixed; the step is applied relative to the moved anchors: the same to first order and
/// far better beyond it where a long part of the drive moves as one.
void ApplyStep(const Eigen::VectorXd& pose_steps, const std::vector<Eigen::Vector3d>& point_steps,
               BundleProblem* problem) {
  for (std::size_t p = 0; p < point_steps.size(); ++p) {
    BundlePoint& point = problem->points[p];
    const int anchor = point.anchor - problem->fixed_frames;
    Eigen::Vector3d step = point_steps[p];
    if (anchor >= 0) step += ChangeByAnchorMotion(point.inverse_depth, pose_steps.segment<6>(Eigen::Index{6} * anchor));
    point.inverse_depth += step;
    point.inverse_depth.z() = std::max(point.inverse_depth.z(), 0.0);  // at most infinity, beyond it depths reverse
  }
  for (Eigen::Index i = 0; i < pose_steps.size() / 6; ++i) {
    geometry::SE3& T_cam_world = problem->T_cam_world[static_cast<std::size_t>(problem->fixed_frames + i)];
    T_cam_world = geometry::SE3::Exp(pose_steps.segment<6>(Eigen::Index{6} * i)) * T_cam_world;
  }
}

}  // namespace

BundleSummary AdjustBundle(const BundleOptions& options, BundleProblem* problem, ThreadPool* pool) {
  const auto begin = FirstObservations(*problem);
  const NoiseModel noise{WhiteningSteps(*problem, options.drift_variance_ratio), options.cauchy_width_px};
  std::vector<double> costs(problem->points.size());
  ForEachIndex(pool, costs.size(), kPointChunk,
               [&](std::size_t p) { costs[p] = PointCost(*problem, noise, begin[p], begin[p + 1]); });
  BundleSummary summary;
  summary.initial_cost = summary.final_cost =
      std::accumulate(costs.begin(), costs.end(), MotionCost(*problem, options.cauchy_width_px));
  NormalEquations equations(*problem, noise, begin, pool);
  double damping = kMinDamping;
  Eigen::VectorXd pose_steps;
  std::vector<Eigen::Vector3d> point_steps;
  for (; summary.iterations < options.max_iterations; ++summary.iterations) {
    equations.Linearize();
    const std::vector<geometry::SE3> old_poses = problem->T_cam_world;
    const std::vector<BundlePoint> old_points = problem->points;
    const std::vector<double> old_costs = costs;
    double cost = std::numeric_limits<double>::infinity();
    while (damping <= kMaxDamping) {
      if (equations.Solve(damping, &pose_steps, &point_steps)) {
        ApplyStep(pose_steps, point_steps, problem);
        cost = UpdateCosts(old_points, noise, begin, pool, &costs, problem);
        if (cost < summary.final_cost) break;
        problem->T_cam_world = old_poses;
        problem->points = old_points;
        costs = old_costs;
      }
      damping = std::max(kMinRetryDamping, kDampingIncrease * damping);
    }
    if (!(cost < summary.final_cost)) break;
    damping = std::max(kMinDamping, kDampingDecrease * damping);
    const double decrease = summary.final_cost - cost;
    summary.final_cost = cost;
    if (decrease < options.min_relative_decrease * cost) break;
  }
  return summary;
}

}  // namespace evo::odometry
