#include "odometry/bundle/bundle_adjuster.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "odometry/bundle/bundle_equations.hpp"

namespace evo::odometry {

namespace {

constexpr double kBehindPx = 1e3;           // error of a point behind the camera; constant, so it pulls nothing
constexpr double kSmallestDamping = 1e-12;  // long drives bend by tiny forces: any more would hold them
constexpr double kRetryDamping = 1e-7;      // at least, after a step that did not help
constexpr double kLargestDamping = 1e6;
constexpr double kLargestMagnification = 10.0;
constexpr std::size_t kPointsAtOnce = 64;
constexpr int kSettleSteps = 3;
constexpr double kSettleDamping = 1e-3;

/// The point relative to the camera, times rho.
Eigen::Vector3d ScaledInCamera(const geometry::SE3& T_cam_anchor, const Eigen::Vector3d& inverse_depth) {
  return T_cam_anchor.rotation() * inverse_depth.head<2>().homogeneous() +
         inverse_depth.z() * T_cam_anchor.translation();
}

/// False if the point is behind the camera.
bool Error(const geometry::SE3& T_cam_anchor, const Eigen::Vector3d& inverse_depth,
           const BundleObservation& observation, Eigen::Vector2d* error) {
  const Eigen::Vector3d y = ScaledInCamera(T_cam_anchor, inverse_depth);
  if (!(y.z() > 0.0)) return false;
  *error = observation.J_pixel_normalized * (observation.x - y.head<2>() / y.z());
  return true;
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Errors of the observations [begin, end) of one point, infinite behind the camera.
void TrackErrors(const BundleProblem& problem, std::size_t begin, std::size_t end,
                 std::vector<Eigen::Vector2d>* errors) {
  errors->assign(end - begin, Eigen::Vector2d::Constant(kInfinity));
  if (begin == end) return;
  const BundlePoint& point = problem.points[problem.observations[begin].point];
  const geometry::SE3 T_world_anchor = problem.T_cam_world[point.anchor].Inverse();
  for (std::size_t i = begin; i < end; ++i) {
    const auto& observation = problem.observations[i];
    const geometry::SE3 T_cam_anchor = problem.T_cam_world[observation.frame] * T_world_anchor;
    Error(T_cam_anchor, point.inverse_depth, observation, &(*errors)[i - begin]);
  }
}

/// Calls f(begin, errors) for the observations of every point, in order; they begin at `begin`.
template <typename Function>
void ForEachTrack(const BundleProblem& problem, const Function& f) {
  std::vector<Eigen::Vector2d> errors;
  const auto begin = FirstObservations(problem);
  for (std::size_t p = 0; p < problem.points.size(); ++p) {
    TrackErrors(problem, begin[p], begin[p + 1], &errors);
    f(begin[p], errors);
  }
}

/// What `filter`, Innovate or EstimateDrift, makes of the errors of every track.
template <typename TrackFilter>
std::vector<Eigen::Vector2d> FilterErrors(const BundleProblem& problem, double drift, const TrackFilter& filter) {
  std::vector<Eigen::Vector2d> filtered, all;
  const auto steps = InnovationSteps(problem, drift);
  ForEachTrack(problem, [&](std::size_t begin, const std::vector<Eigen::Vector2d>& errors) {
    filter(std::span(steps).subspan(begin, errors.size()), errors, &filtered);
    all.insert(all.end(), filtered.begin(), filtered.end());
  });
  return all;
}

/// What the observations [begin, end) of one point cost.
double PointCost(const BundleProblem& problem, const ErrorModel& model, std::size_t begin, std::size_t end) {
  thread_local std::vector<Eigen::Vector2d> errors, innovations;
  TrackErrors(problem, begin, end, &errors);
  Innovate(model.Steps(begin, end), errors, &innovations);
  double cost = 0.0;
  for (const auto& innovation : innovations) {
    cost += CauchyCost(std::min(innovation.squaredNorm(), kBehindPx * kBehindPx), model.loss_px);
  }
  return cost;
}

/// What the changes of velocity cost.
double MotionCost(const BundleProblem& problem, double loss_px) {
  const MotionPrior& motion = problem.motion;
  double cost = 0.0;
  for (std::size_t i = 1; i + 1 < motion.t.size(); ++i) {
    const geometry::Vector6d change = MeasureVelocityChange(problem.T_cam_world, motion.t, i);
    cost += CauchyCost((motion.translation_px * change.head<3>()).squaredNorm(), loss_px) +
            CauchyCost((motion.rotation_px * change.tail<3>()).squaredNorm(), loss_px);
  }
  return cost;
}

/// A few damped steps of one point alone.
double SettlePoint(const ErrorModel& model, std::size_t begin, std::size_t end, BundleProblem* problem) {
  thread_local TrackEquations track;
  BundlePoint& point = problem->points[problem->observations[begin].point];
  double cost = PointCost(*problem, model, begin, end);
  double damping = kSettleDamping;
  for (int step = 0; step < kSettleSteps; ++step) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    Eigen::Matrix<double, 2, 3> by_point;
    track.Linearize(*problem, model, begin, end);
    for (std::size_t k = 0; k < end - begin; ++k) {
      const Eigen::Vector2d error = track.Weighted(k, &by_point);
      normal.noalias() += track.sightings[k].by_point.transpose() * by_point;
      gradient.noalias() += track.sightings[k].by_point.transpose() * error;
    }
    normal.diagonal() *= 1.0 + damping;
    normal.diagonal().array() += 1e-12;
    const Eigen::Vector3d old = point.inverse_depth;
    point.inverse_depth -= normal.ldlt().solve(gradient);
    point.inverse_depth.z() = std::max(point.inverse_depth.z(), 0.0);
    const double stepped = PointCost(*problem, model, begin, end);
    if (stepped < cost) {
      cost = stepped;
      damping *= 0.1;
    } else {
      point.inverse_depth = old;
      damping *= 100.0;
    }
  }
  return cost;
}

/// All costs after a step. A point that the common step has made worse, one far away or nearly on the path,
/// goes back and settles by itself, lest it hold up all the others.
double CostAfterStep(const std::vector<BundlePoint>& old_points, const ErrorModel& model,
                     const std::vector<std::size_t>& begin, ThreadPool* pool, std::vector<double>* costs,
                     BundleProblem* problem) {
  ForEachIndex(pool, costs->size(), kPointsAtOnce, [&](std::size_t p) {
    if (begin[p] == begin[p + 1]) return;
    double cost = PointCost(*problem, model, begin[p], begin[p + 1]);
    if (cost > (*costs)[p]) {
      const BundlePoint stepped = std::exchange(problem->points[p], old_points[p]);
      if (PointCost(*problem, model, begin[p], begin[p + 1]) > cost) problem->points[p] = stepped;
      cost = SettlePoint(model, begin[p], begin[p + 1], problem);
    }
    (*costs)[p] = cost;
  });
  return std::accumulate(costs->begin(), costs->end(), MotionCost(*problem, model.loss_px));
}

/// What a point's numbers lose when its anchor moves by the left twist and the point stays, to first order.
Eigen::Vector3d CarriedByAnchor(const Eigen::Vector3d& inverse_depth, const geometry::Vector6d& twist) {
  const Eigen::Vector3d ray = inverse_depth.head<2>().homogeneous();
  const Eigen::Vector3d u = inverse_depth.z() * twist.head<3>() + twist.tail<3>().cross(ray);
  return {-u.x() + ray.x() * u.z(), -u.y() + ray.y() * u.z(), inverse_depth.z() * u.z()};
}

/// The equations hold the points' anchors, but the step moves the points along with them: the same to first order, and
/// far better beyond it where a long stretch of the drive moves as one.
void Apply(const Eigen::VectorXd& pose_steps, const std::vector<Eigen::Vector3d>& point_steps, BundleProblem* problem) {
  for (std::size_t p = 0; p < point_steps.size(); ++p) {
    BundlePoint& point = problem->points[p];
    const int anchor = point.anchor - problem->fixed_frames;
    Eigen::Vector3d step = point_steps[p];
    if (anchor >= 0) step -= CarriedByAnchor(point.inverse_depth, pose_steps.segment<6>(Eigen::Index{6} * anchor));
    point.inverse_depth += step;
    point.inverse_depth.z() = std::max(point.inverse_depth.z(), 0.0);  // not beyond infinity, where depths reverse
  }
  for (Eigen::Index i = 0; i < pose_steps.size() / 6; ++i) {
    geometry::SE3& pose = problem->T_cam_world[static_cast<std::size_t>(problem->fixed_frames + i)];
    pose = geometry::SE3::Exp(pose_steps.segment<6>(Eigen::Index{6} * i)) * pose;
  }
}

}  // namespace

std::vector<std::size_t> FirstObservations(const BundleProblem& problem) {
  std::vector<std::size_t> begin(problem.points.size() + 1, problem.observations.size());
  for (std::size_t i = problem.observations.size(); i-- > 0;) begin[problem.observations[i].point] = i;
  for (std::size_t p = problem.points.size(); p-- > 0;) begin[p] = std::min(begin[p], begin[p + 1]);
  return begin;
}

std::vector<InnovationStep> InnovationSteps(const BundleProblem& problem, double drift) {
  std::vector<InnovationStep> steps;
  std::vector<double> magnifications;
  const auto begin = FirstObservations(problem);
  for (std::size_t p = 0; p < problem.points.size(); ++p) {
    magnifications.clear();
    const BundlePoint& point = problem.points[p];
    const geometry::SE3 T_world_anchor = problem.T_cam_world[point.anchor].Inverse();
    for (std::size_t i = begin[p]; i < begin[p + 1]; ++i) {
      const geometry::SE3 T_cam_anchor = problem.T_cam_world[problem.observations[i].frame] * T_world_anchor;
      const double depth_share = ScaledInCamera(T_cam_anchor, point.inverse_depth).z();  // of that at first
      magnifications.push_back(1.0 / std::clamp(depth_share, 1.0 / kLargestMagnification, kLargestMagnification));
    }
    AppendInnovationSteps(drift, magnifications, &steps);
    for (std::size_t i = begin[p]; i < begin[p + 1]; ++i) steps[i].scale *= point.weight;
  }
  return steps;
}

Eigen::Vector3d WorldPosition(const BundleProblem& problem, const BundlePoint& point) {
  return problem.T_cam_world[point.anchor].Inverse() *
         Eigen::Vector3d(point.inverse_depth.head<2>().homogeneous() / point.inverse_depth.z());
}

bool Linearize(const geometry::SE3& T_cam_anchor, const Eigen::Vector3d& inverse_depth,
               const BundleObservation& observation, BundleJacobian* jacobian) {
  const Eigen::Vector3d y = ScaledInCamera(T_cam_anchor, inverse_depth);
  if (!(y.z() > 0.0)) return false;
  const Eigen::Vector2d projection = y.head<2>() / y.z();
  jacobian->error = observation.J_pixel_normalized * (observation.x - projection);
  Eigen::Matrix<double, 2, 3> by_y;
  by_y << 1.0, 0.0, -projection.x(), 0.0, 1.0, -projection.y();
  by_y = observation.J_pixel_normalized * by_y / -y.z();
  jacobian->by_pose.leftCols<3>() = inverse_depth.z() * by_y;
  jacobian->by_pose.rightCols<3>().noalias() = -by_y * geometry::so3::Hat(y);
  jacobian->by_point.leftCols<2>().noalias() = by_y * T_cam_anchor.RotationMatrix().leftCols<2>();
  jacobian->by_point.col(2).noalias() = by_y * T_cam_anchor.translation();
  return true;
}

std::vector<Eigen::Vector2d> BundleErrors(const BundleProblem& problem) {
  std::vector<Eigen::Vector2d> all;
  ForEachTrack(problem, [&](std::size_t, const std::vector<Eigen::Vector2d>& errors) {
    all.insert(all.end(), errors.begin(), errors.end());
  });
  return all;
}

std::vector<Eigen::Vector2d> BundleInnovations(const BundleProblem& problem, double drift) {
  return FilterErrors(problem, drift, Innovate);
}

std::vector<Eigen::Vector2d> BundleDrifts(const BundleProblem& problem, double drift) {
  return FilterErrors(problem, drift, EstimateDrift);
}

std::vector<int> BundleSkyline(const BundleProblem& problem) {
  const int poses = std::max(0, static_cast<int>(problem.T_cam_world.size()) - problem.fixed_frames);
  std::vector<int> first(static_cast<std::size_t>(poses));
  for (int i = 0; i < poses; ++i) first[i] = problem.motion.t.empty() ? i : std::max(0, i - 2);
  int point = -1;
  int lowest = 0;
  for (const auto& observation : problem.observations) {  // in order of points, then of frames
    const int pose = observation.frame - problem.fixed_frames;
    if (pose < 0) continue;
    if (observation.point != point) {
      point = observation.point;
      lowest = pose;
    }
    first[pose] = std::min(first[pose], lowest);
  }
  return first;
}

BundleSummary AdjustBundle(const BundleOptions& options, BundleProblem* problem, ThreadPool* pool) {
  const auto begin = FirstObservations(*problem);
  const ErrorModel model{InnovationSteps(*problem, options.drift), options.loss_px};
  std::vector<double> costs(problem->points.size());
  ForEachIndex(pool, costs.size(), kPointsAtOnce,
               [&](std::size_t p) { costs[p] = PointCost(*problem, model, begin[p], begin[p + 1]); });
  BundleSummary summary;
  summary.initial_cost = summary.final_cost =
      std::accumulate(costs.begin(), costs.end(), MotionCost(*problem, options.loss_px));
  BundleEquations equations(*problem, model, begin, pool);
  double damping = kSmallestDamping;
  Eigen::VectorXd pose_steps;
  std::vector<Eigen::Vector3d> point_steps;
  for (; summary.iterations < options.iterations; ++summary.iterations) {
    equations.Linearize();
    const std::vector<geometry::SE3> old_poses = problem->T_cam_world;
    const std::vector<BundlePoint> old_points = problem->points;
    const std::vector<double> old_costs = costs;
    double cost = kInfinity;
    while (damping <= kLargestDamping) {
      if (equations.Solve(damping, &pose_steps, &point_steps)) {
        Apply(pose_steps, point_steps, problem);
        cost = CostAfterStep(old_points, model, begin, pool, &costs, problem);
        if (cost < summary.final_cost) break;
        problem->T_cam_world = old_poses;
        problem->points = old_points;
        costs = old_costs;
      }
      damping = std::max(kRetryDamping, 10.0 * damping);
    }
    if (!(cost < summary.final_cost)) break;
    damping = std::max(kSmallestDamping, 0.03 * damping);
    const double decrease = summary.final_cost - cost;
    summary.final_cost = cost;
    if (decrease < options.relative_decrease * cost) break;
  }
  return summary;
}

}  // namespace evo::odometry
