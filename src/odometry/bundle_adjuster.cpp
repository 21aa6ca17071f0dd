#include "evo/odometry/bundle_adjuster.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "evo/odometry/block_skyline.hpp"

namespace evo {

namespace {

constexpr double kBehindPx = 1e3;  // what a point behind the camera costs; constant, so it pulls nothing
constexpr double kFirstDamping = 1e-5;
constexpr double kSmallestDamping = 1e-9;
constexpr double kLargestDamping = 1e6;

using Matrix63 = Eigen::Matrix<double, 6, 3>;

double CauchyCost(double squared, double width) { return 0.5 * width * width * std::log1p(squared / (width * width)); }

double CauchyWeight(double squared, double width) { return 1.0 / (1.0 + squared / (width * width)); }

/// The point relative to the camera, times rho.
Eigen::Vector3d ScaledInCamera(const SE3& T_cam_anchor, const Eigen::Vector3d& inverse_depth) {
  return T_cam_anchor.rotation() * inverse_depth.head<2>().homogeneous() +
         inverse_depth.z() * T_cam_anchor.translation();
}

double Cost(const BundleProblem& problem, double width) {
  double cost = 0.0;
  for (const double norm : BundleResiduals(problem)) {
    cost += CauchyCost(std::min(norm * norm, kBehindPx * kBehindPx), width);
  }
  return cost;
}

/// The normal equations of one linearisation, the points' part kept apart.
class NormalEquations {
 public:
  NormalEquations(const BundleProblem& problem, const std::vector<int>& skyline)
      : problem_(problem), pose_blocks_(skyline.size()), reduced_(skyline) {
    const auto& observations = problem.observations;
    point_begin_.assign(problem.points.size() + 1, observations.size());
    for (std::size_t i = observations.size(); i-- > 0;) point_begin_[observations[i].point] = i;
    for (std::size_t p = problem.points.size(); p-- > 0;) {
      point_begin_[p] = std::min(point_begin_[p], point_begin_[p + 1]);
    }
    cross_.resize(observations.size());
    point_blocks_.resize(problem.points.size());
    point_gradients_.resize(problem.points.size());
  }

  void Linearize(double width) {
    std::ranges::fill(pose_blocks_, BlockSkyline::Block::Zero());
    std::ranges::fill(point_blocks_, Eigen::Matrix3d::Zero());
    std::ranges::fill(point_gradients_, Eigen::Vector3d::Zero());
    pose_gradient_ = Eigen::VectorXd::Zero(6 * reduced_.rows());
    BundleJacobian jacobian;
    for (std::size_t i = 0; i < problem_.observations.size(); ++i) {
      const auto& observation = problem_.observations[i];
      cross_[i].setZero();
      const SE3& T_cam_world = problem_.T_cam_world[observation.frame];
      if (!evo::Linearize(T_cam_world, problem_.points[observation.point], observation, &jacobian)) continue;
      const double weight = CauchyWeight(jacobian.error.squaredNorm(), width);
      const Eigen::Matrix<double, 3, 2> weighted = weight * jacobian.by_point.transpose();
      point_blocks_[observation.point].noalias() += weighted * jacobian.by_point;
      point_gradients_[observation.point].noalias() += weighted * jacobian.error;
      const int pose = observation.frame - problem_.fixed_frames;
      if (pose < 0) continue;
      const Eigen::Matrix<double, 6, 2> turned = weight * jacobian.by_pose.transpose();
      pose_blocks_[pose].noalias() += turned.lazyProduct(jacobian.by_pose);
      pose_gradient_.segment<6>(6 * pose).noalias() += turned * jacobian.error;
      cross_[i].noalias() = turned.lazyProduct(jacobian.by_point);
    }
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
    inverses_.resize(problem_.points.size());
    for (std::size_t p = 0; p < problem_.points.size(); ++p) EliminatePoint(p, lambda, &right);
    if (reduced_.rows() > 0) {
      if (!reduced_.Factorize()) return false;
      *pose_steps = reduced_.Solve(right);
    } else {
      pose_steps->resize(0);
    }
    point_steps->resize(problem_.points.size());
    for (std::size_t p = 0; p < problem_.points.size(); ++p) {
      Eigen::Vector3d sum = -point_gradients_[p];
      for (std::size_t i = point_begin_[p]; i < point_begin_[p + 1]; ++i) {
        const int pose = problem_.observations[i].frame - problem_.fixed_frames;
        if (pose >= 0) sum.noalias() -= cross_[i].transpose() * pose_steps->segment<6>(6 * pose);
      }
      (*point_steps)[p] = inverses_[p] * sum;
    }
    return pose_steps->allFinite();
  }

 private:
  void EliminatePoint(std::size_t p, double lambda, Eigen::VectorXd* right) {
    Eigen::Matrix3d damped = point_blocks_[p];
    damped.diagonal() *= 1.0 + lambda;
    damped.diagonal().array() += 1e-9 * damped.diagonal().maxCoeff() + 1e-12;
    inverses_[p] = damped.inverse();
    for (std::size_t i = point_begin_[p]; i < point_begin_[p + 1]; ++i) {
      const int row = problem_.observations[i].frame - problem_.fixed_frames;
      if (row < 0) continue;
      const Matrix63 scaled = cross_[i] * inverses_[p];
      right->segment<6>(6 * row).noalias() += scaled * point_gradients_[p];
      for (std::size_t j = point_begin_[p]; j <= i; ++j) {
        const int column = problem_.observations[j].frame - problem_.fixed_frames;
        if (column >= 0) reduced_.At(row, column).noalias() -= scaled.lazyProduct(cross_[j].transpose());
      }
    }
  }

  const BundleProblem& problem_;
  std::vector<std::size_t> point_begin_;
  std::vector<BlockSkyline::Block> pose_blocks_;
  std::vector<Eigen::Matrix3d> point_blocks_;
  std::vector<Eigen::Matrix3d> inverses_;
  std::vector<Eigen::Vector3d> point_gradients_;
  std::vector<Matrix63> cross_;
  Eigen::VectorXd pose_gradient_;
  BlockSkyline reduced_;
};

void Apply(const Eigen::VectorXd& pose_steps, const std::vector<Eigen::Vector3d>& point_steps, BundleProblem* problem) {
  for (Eigen::Index i = 0; i < pose_steps.size() / 6; ++i) {
    SE3& pose = problem->T_cam_world[static_cast<std::size_t>(problem->fixed_frames + i)];
    pose = SE3::Exp(pose_steps.segment<6>(6 * i)) * pose;
  }
  for (std::size_t p = 0; p < point_steps.size(); ++p) problem->points[p].inverse_depth += point_steps[p];
}

}  // namespace

Eigen::Vector3d BundlePoint::World() const {
  return T_world_anchor * Eigen::Vector3d(inverse_depth.head<2>().homogeneous() / inverse_depth.z());
}

bool Linearize(const SE3& T_cam_world, const BundlePoint& point, const BundleObservation& observation,
               BundleJacobian* jacobian) {
  const SE3 T_cam_anchor = T_cam_world * point.T_world_anchor;
  const Eigen::Vector3d y = ScaledInCamera(T_cam_anchor, point.inverse_depth);
  if (!(y.z() > 0.0)) return false;
  const Eigen::Vector2d projection = y.head<2>() / y.z();
  jacobian->error = observation.px_per_unit * (observation.x - projection);
  Eigen::Matrix<double, 2, 3> by_y;
  by_y << 1.0, 0.0, -projection.x(), 0.0, 1.0, -projection.y();
  by_y = observation.px_per_unit * by_y / -y.z();
  jacobian->by_pose.leftCols<3>() = point.inverse_depth.z() * by_y;
  jacobian->by_pose.rightCols<3>().noalias() = -by_y * so3::Hat(y);
  jacobian->by_point.leftCols<2>().noalias() = by_y * T_cam_anchor.RotationMatrix().leftCols<2>();
  jacobian->by_point.col(2).noalias() = by_y * T_cam_anchor.translation();
  return true;
}

std::vector<double> BundleResiduals(const BundleProblem& problem) {
  std::vector<double> norms(problem.observations.size());
  for (std::size_t i = 0; i < norms.size(); ++i) {
    const auto& observation = problem.observations[i];
    const auto& point = problem.points[observation.point];
    const Eigen::Vector3d y =
        ScaledInCamera(problem.T_cam_world[observation.frame] * point.T_world_anchor, point.inverse_depth);
    norms[i] = y.z() > 0.0 ? (observation.px_per_unit * (observation.x - y.head<2>() / y.z())).norm()
                           : std::numeric_limits<double>::infinity();
  }
  return norms;
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
  BundleSummary summary;
  summary.initial_cost = summary.final_cost = Cost(*problem, options.loss_px);
  NormalEquations equations(*problem, BundleSkyline(*problem));
  double damping = kFirstDamping;
  Eigen::VectorXd pose_steps;
  std::vector<Eigen::Vector3d> point_steps;
  for (; summary.iterations < options.iterations; ++summary.iterations) {
    equations.Linearize(options.loss_px);
    const std::vector<SE3> poses = problem->T_cam_world;
    const std::vector<BundlePoint> points = problem->points;
    double cost = std::numeric_limits<double>::infinity();
    while (damping <= kLargestDamping) {
      if (equations.Solve(damping, &pose_steps, &point_steps)) {
        Apply(pose_steps, point_steps, problem);
        cost = Cost(*problem, options.loss_px);
        if (cost < summary.final_cost) break;
        problem->T_cam_world = poses;
        problem->points = points;
      }
      damping *= 10.0;
    }
    if (!(cost < summary.final_cost)) break;
    damping = std::max(kSmallestDamping, 0.1 * damping);
    const double decrease = summary.final_cost - cost;
    summary.final_cost = cost;
    if (decrease < options.relative_decrease * cost) break;
  }
  return summary;
}

}  // namespace evo
