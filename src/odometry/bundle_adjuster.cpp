#include "evo/odometry/bundle_adjuster.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "evo/odometry/block_skyline.hpp"

namespace evo {

namespace {

constexpr double kBehindPx = 1e3;  // error of a point behind the camera; constant, so it pulls nothing
constexpr double kFirstDamping = 1e-12;
constexpr double kSmallestDamping = 1e-12;  // long drives bend by tiny forces: any more would hold them
constexpr double kRetryDamping = 1e-7;      // at least, after a step that did not help
constexpr double kScalePrior = 1e3;         // px: what doubling the scale would cost
constexpr double kLargestDamping = 1e6;

constexpr int kSettleSteps = 3;
constexpr double kSettleDamping = 1e-3;

using Matrix63 = Eigen::Matrix<double, 6, 3>;

double CauchyCost(double squared, double width) { return 0.5 * width * width * std::log1p(squared / (width * width)); }

double CauchyWeight(double squared, double width) { return 1.0 / (1.0 + squared / (width * width)); }

/// The point relative to the camera, times rho.
Eigen::Vector3d ScaledInCamera(const SE3& T_cam_anchor, const Eigen::Vector3d& inverse_depth) {
  return T_cam_anchor.rotation() * inverse_depth.head<2>().homogeneous() +
         inverse_depth.z() * T_cam_anchor.translation();
}

/// False if the point is behind the camera.
bool Error(const SE3& T_cam_anchor, const Eigen::Vector3d& inverse_depth, const BundleObservation& observation,
           Eigen::Vector2d* error) {
  const Eigen::Vector3d y = ScaledInCamera(T_cam_anchor, inverse_depth);
  if (!(y.z() > 0.0)) return false;
  *error = observation.px_per_unit * (observation.x - y.head<2>() / y.z());
  return true;
}

double ScaleLength(const BundleProblem& problem) {
  return (problem.T_cam_world[problem.scale_frame] * problem.T_cam_world.front().Inverse()).translation().norm();
}

/// Error of the length that holds the scale; by_pose for the scale frame.
double ScaleError(const BundleProblem& problem, double length, Eigen::Matrix<double, 1, 6>* by_pose) {
  const SE3 T_cam_first = problem.T_cam_world[problem.scale_frame] * problem.T_cam_world.front().Inverse();
  const Eigen::Vector3d t = T_cam_first.translation();
  const double norm = std::max(t.norm(), 1e-12);
  // |t| does not change when the camera turns about its own centre; a left turn moves t across itself.
  if (by_pose) *by_pose << kScalePrior / length * t.transpose() / norm, 0.0, 0.0, 0.0;
  return kScalePrior * (norm / length - 1.0);
}

std::vector<std::size_t> FirstObservations(const BundleProblem& problem) {
  std::vector<std::size_t> begin(problem.points.size() + 1, problem.observations.size());
  for (std::size_t i = problem.observations.size(); i-- > 0;) begin[problem.observations[i].point] = i;
  for (std::size_t p = problem.points.size(); p-- > 0;) begin[p] = std::min(begin[p], begin[p + 1]);
  return begin;
}

/// What the observations [begin, end) of one point cost.
double PointCost(const BundleProblem& problem, double width, std::size_t begin, std::size_t end) {
  if (begin == end) return 0.0;
  double cost = 0.0;
  const BundlePoint& point = problem.points[problem.observations[begin].point];
  const SE3 T_world_anchor = problem.T_cam_world[point.anchor].Inverse();
  for (std::size_t i = begin; i < end; ++i) {
    const auto& observation = problem.observations[i];
    const SE3 T_cam_anchor = problem.T_cam_world[observation.frame] * T_world_anchor;
    Eigen::Vector2d error;
    const bool visible = Error(T_cam_anchor, point.inverse_depth, observation, &error);
    const double squared = visible ? error.squaredNorm() : kBehindPx * kBehindPx;
    cost += CauchyCost(std::min(squared, kBehindPx * kBehindPx), width);
  }
  return cost;
}

/// A few damped steps of one point alone.
double SettlePoint(double width, std::size_t begin, std::size_t end, BundleProblem* problem) {
  BundlePoint& point = problem->points[problem->observations[begin].point];
  const SE3 T_world_anchor = problem->T_cam_world[point.anchor].Inverse();
  double cost = PointCost(*problem, width, begin, end);
  double damping = kSettleDamping;
  for (int step = 0; step < kSettleSteps; ++step) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    BundleJacobian jacobian;
    for (std::size_t i = begin; i < end; ++i) {
      const auto& observation = problem->observations[i];
      const SE3 T_cam_anchor = problem->T_cam_world[observation.frame] * T_world_anchor;
      if (!Linearize(T_cam_anchor, point.inverse_depth, observation, &jacobian)) continue;
      const double weight = CauchyWeight(jacobian.error.squaredNorm(), width);
      normal.noalias() += weight * jacobian.by_point.transpose() * jacobian.by_point;
      gradient.noalias() += weight * jacobian.by_point.transpose() * jacobian.error;
    }
    normal.diagonal() *= 1.0 + damping;
    normal.diagonal().array() += 1e-12;
    const Eigen::Vector3d old = point.inverse_depth;
    point.inverse_depth -= normal.ldlt().solve(gradient);
    point.inverse_depth.z() = std::max(point.inverse_depth.z(), 0.0);
    const double stepped = PointCost(*problem, width, begin, end);
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

/// All points' costs after a step. A point that the common step has made worse, one far away or nearly on the path,
/// goes back and settles by itself, lest it hold up all the others.
double CostAfterStep(const std::vector<BundlePoint>& old_points, double width, const std::vector<std::size_t>& begin,
                     std::vector<double>* costs, BundleProblem* problem) {
  double sum = 0.0;
  for (std::size_t p = 0; p < costs->size(); ++p) {
    if (begin[p] == begin[p + 1]) continue;
    double cost = PointCost(*problem, width, begin[p], begin[p + 1]);
    if (cost > (*costs)[p]) {
      const BundlePoint stepped = std::exchange(problem->points[p], old_points[p]);
      if (PointCost(*problem, width, begin[p], begin[p + 1]) > cost) problem->points[p] = stepped;
      cost = SettlePoint(width, begin[p], begin[p + 1], problem);
    }
    (*costs)[p] = cost;
    sum += cost;
  }
  return sum;
}

/// The normal equations of one linearisation, the points' part kept apart.
class NormalEquations {
 public:
  NormalEquations(const BundleProblem& problem, double width, const std::vector<std::size_t>& begin,
                  double scale_length)
      : problem_(problem),
        width_(width),
        begin_(begin),
        scale_length_(scale_length),
        reduced_(BundleSkyline(problem)),
        pose_blocks_(static_cast<std::size_t>(reduced_.rows())),
        cross_(problem.observations.size()),
        point_blocks_(problem.points.size()),
        inverses_(problem.points.size()),
        point_gradients_(problem.points.size()) {}

  void Linearize() {
    std::ranges::fill(pose_blocks_, BlockSkyline::Block::Zero());
    pose_gradient_ = Eigen::VectorXd::Zero(6 * reduced_.rows());
    for (std::size_t p = 0; p < problem_.points.size(); ++p) LinearizePoint(p);
    const int pose = problem_.scale_frame - problem_.fixed_frames;
    if (pose < 0) return;
    Eigen::Matrix<double, 1, 6> by_pose;
    const double error = ScaleError(problem_, scale_length_, &by_pose);
    pose_blocks_[pose] += by_pose.transpose() * by_pose;
    pose_gradient_.segment<6>(6 * pose) += by_pose.transpose() * error;
  }

  /// Steps of poses and points for a damping `lambda`; false if the system is singular.
  bool Solve(double lambda, Eigen::VectorXd* pose_steps, std::vector<Eigen::Vector3d>* point_steps) {
    reduced_.SetZero();
    Eigen::VectorXd right = -pose_gradient_;
    for (int i = 0; i < reduced_.rows(); ++i) {
      reduced_.At(i, i) = pose_blocks_[i];
      reduced_.At(i, i).diagonal() *= 1.0 + lambda;
      reduced_.At(i, i).diagonal().array() += 1e-12;
    }
    for (std::size_t p = 0; p < problem_.points.size(); ++p) EliminatePoint(p, lambda, &right);
    if (!reduced_.Factorize()) return false;
    *pose_steps = reduced_.Solve(right);
    point_steps->resize(problem_.points.size());
    for (std::size_t p = 0; p < problem_.points.size(); ++p) {
      Eigen::Vector3d sum = -point_gradients_[p];
      for (std::size_t i = begin_[p]; i < begin_[p + 1]; ++i) {
        const int pose = Pose(i);
        if (pose >= 0) sum.noalias() -= cross_[i].transpose() * pose_steps->segment<6>(6 * pose);
      }
      (*point_steps)[p] = inverses_[p] * sum;
    }
    return pose_steps->allFinite();
  }

 private:
  int Pose(std::size_t observation) const { return problem_.observations[observation].frame - problem_.fixed_frames; }

  void LinearizePoint(std::size_t p) {
    point_blocks_[p].setZero();
    point_gradients_[p].setZero();
    const BundlePoint& point = problem_.points[p];
    const SE3 T_world_anchor = problem_.T_cam_world[point.anchor].Inverse();
    BundleJacobian jacobian;
    for (std::size_t i = begin_[p]; i < begin_[p + 1]; ++i) {
      cross_[i].setZero();
      const auto& observation = problem_.observations[i];
      const SE3 T_cam_anchor = problem_.T_cam_world[observation.frame] * T_world_anchor;
      if (!evo::Linearize(T_cam_anchor, point.inverse_depth, observation, &jacobian)) continue;
      const double weight = CauchyWeight(jacobian.error.squaredNorm(), width_);
      const Eigen::Matrix<double, 3, 2> weighted = weight * jacobian.by_point.transpose();
      point_blocks_[p].noalias() += weighted.lazyProduct(jacobian.by_point);
      point_gradients_[p].noalias() += weighted * jacobian.error;
      const int pose = Pose(i);
      if (pose < 0) continue;
      const Eigen::Matrix<double, 6, 2> turned = weight * jacobian.by_pose.transpose();
      pose_blocks_[pose].noalias() += turned.lazyProduct(jacobian.by_pose);
      pose_gradient_.segment<6>(6 * pose).noalias() += turned * jacobian.error;
      cross_[i].noalias() = turned.lazyProduct(jacobian.by_point);
    }
  }

  void EliminatePoint(std::size_t p, double lambda, Eigen::VectorXd* right) {
    Eigen::Matrix3d damped = point_blocks_[p];
    damped.diagonal() *= 1.0 + lambda;
    damped.diagonal().array() += 1e-9 * damped.diagonal().maxCoeff() + 1e-12;
    inverses_[p] = damped.inverse();
    for (std::size_t i = begin_[p]; i < begin_[p + 1]; ++i) {
      const int row = Pose(i);
      if (row < 0) continue;
      const Matrix63 scaled = cross_[i] * inverses_[p];
      right->segment<6>(6 * row).noalias() += scaled * point_gradients_[p];
      for (std::size_t j = begin_[p]; j <= i; ++j) {
        const int column = Pose(j);
        if (column >= 0) reduced_.At(row, column).noalias() -= scaled.lazyProduct(cross_[j].transpose());
      }
    }
  }

  const BundleProblem& problem_;
  double width_;
  const std::vector<std::size_t>& begin_;  // of every point's observations
  double scale_length_;
  BlockSkyline reduced_;
  std::vector<BlockSkyline::Block> pose_blocks_;
  std::vector<Matrix63> cross_;
  std::vector<Eigen::Matrix3d> point_blocks_;
  std::vector<Eigen::Matrix3d> inverses_;
  std::vector<Eigen::Vector3d> point_gradients_;
  Eigen::VectorXd pose_gradient_;
};

/// What a point's numbers lose when its anchor moves by the left twist and the point stays, to first order.
Eigen::Vector3d CarriedByAnchor(const Eigen::Vector3d& inverse_depth, const Vector6d& twist) {
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
    if (anchor >= 0) step -= CarriedByAnchor(point.inverse_depth, pose_steps.segment<6>(6 * anchor));
    point.inverse_depth += step;
    point.inverse_depth.z() = std::max(point.inverse_depth.z(), 0.0);  // not beyond infinity, where depths reverse
  }
  for (Eigen::Index i = 0; i < pose_steps.size() / 6; ++i) {
    SE3& pose = problem->T_cam_world[static_cast<std::size_t>(problem->fixed_frames + i)];
    pose = SE3::Exp(pose_steps.segment<6>(6 * i)) * pose;
  }
}

}  // namespace

Eigen::Vector3d WorldPosition(const BundleProblem& problem, const BundlePoint& point) {
  return problem.T_cam_world[point.anchor].Inverse() *
         Eigen::Vector3d(point.inverse_depth.head<2>().homogeneous() / point.inverse_depth.z());
}

bool Linearize(const SE3& T_cam_anchor, const Eigen::Vector3d& inverse_depth, const BundleObservation& observation,
               BundleJacobian* jacobian) {
  const Eigen::Vector3d y = ScaledInCamera(T_cam_anchor, inverse_depth);
  if (!(y.z() > 0.0)) return false;
  const Eigen::Vector2d projection = y.head<2>() / y.z();
  jacobian->error = observation.px_per_unit * (observation.x - projection);
  Eigen::Matrix<double, 2, 3> by_y;
  by_y << 1.0, 0.0, -projection.x(), 0.0, 1.0, -projection.y();
  by_y = observation.px_per_unit * by_y / -y.z();
  jacobian->by_pose.leftCols<3>() = inverse_depth.z() * by_y;
  jacobian->by_pose.rightCols<3>().noalias() = -by_y * so3::Hat(y);
  jacobian->by_point.leftCols<2>().noalias() = by_y * T_cam_anchor.RotationMatrix().leftCols<2>();
  jacobian->by_point.col(2).noalias() = by_y * T_cam_anchor.translation();
  return true;
}

std::vector<Eigen::Vector2d> BundleErrors(const BundleProblem& problem) {
  std::vector<Eigen::Vector2d> errors(problem.observations.size());
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const auto& observation = problem.observations[i];
    const BundlePoint& point = problem.points[observation.point];
    const SE3 T_cam_anchor = problem.T_cam_world[observation.frame] * problem.T_cam_world[point.anchor].Inverse();
    if (Error(T_cam_anchor, point.inverse_depth, observation, &errors[i])) continue;
    errors[i].setConstant(std::numeric_limits<double>::infinity());
  }
  return errors;
}

std::vector<int> BundleSkyline(const BundleProblem& problem) {
  const int poses = std::max(0, static_cast<int>(problem.T_cam_world.size()) - problem.fixed_frames);
  std::vector<int> first(static_cast<std::size_t>(poses));
  std::iota(first.begin(), first.end(), 0);
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

BundleSummary AdjustBundle(const BundleOptions& options, BundleProblem* problem) {
  const double width = options.loss_px;
  const auto begin = FirstObservations(*problem);
  const double scale_length = problem->scale_frame < 0 ? 1.0 : ScaleLength(*problem);
  std::vector<double> costs(problem->points.size());
  for (std::size_t p = 0; p < costs.size(); ++p) costs[p] = PointCost(*problem, width, begin[p], begin[p + 1]);
  BundleSummary summary;
  summary.initial_cost = summary.final_cost = std::accumulate(costs.begin(), costs.end(), 0.0);
  NormalEquations equations(*problem, width, begin, scale_length);
  double damping = kFirstDamping;
  Eigen::VectorXd pose_steps;
  std::vector<Eigen::Vector3d> point_steps;
  for (; summary.iterations < options.iterations; ++summary.iterations) {
    equations.Linearize();
    const std::vector<SE3> old_poses = problem->T_cam_world;
    const std::vector<BundlePoint> old_points = problem->points;
    const std::vector<double> old_costs = costs;
    double cost = std::numeric_limits<double>::infinity();
    while (damping <= kLargestDamping) {
      if (equations.Solve(damping, &pose_steps, &point_steps)) {
        Apply(pose_steps, point_steps, problem);
        cost = CostAfterStep(old_points, width, begin, &costs, problem);
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

}  // namespace evo
