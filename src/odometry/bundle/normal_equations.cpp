#include "odometry/bundle/normal_equations.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <utility>

#include "evo/core/robust.hpp"

namespace evo::odometry {

namespace {

constexpr double kScaleWeightPx = 1e3;  // error of a doubled scale: far above all others, yet no loss of precision
constexpr double kPointDamping = 1e-9;  // of a point's largest entry: a point on the path has no depth
constexpr double kMinDiagonal = 1e-12;  // keeps a pose or point without observations from being singular

Eigen::Index PoseIndex(int row) { return Eigen::Index{6} * row; }

/// From the first camera to the one that holds the scale.
Eigen::Vector3d ScaleBaseline(const BundleProblem& problem) {
  return (problem.T_cam_world[problem.scale_frame] * problem.T_cam_world.front().Inverse()).translation();
}

}  // namespace

NormalEquations::NormalEquations(const BundleProblem& problem, const NoiseModel& noise,
                                 const std::vector<std::size_t>& first_observations, ThreadPool* pool)
    : problem_(problem),
      noise_(noise),
      begin_(first_observations),
      batches_(problem, first_observations, pool),
      held_distance_(problem.scale_frame < 0 ? 1.0 : ScaleBaseline(problem).norm()),
      pose_hessian_(ReducedSystemSkyline(problem)),
      reduced_hessian_(pose_hessian_),
      points_(problem.points.size()),
      observations_(problem.observations.size()) {}

void NormalEquations::Linearize() {
  pose_hessian_.SetZero();
  pose_gradient_ = Eigen::VectorXd::Zero(PoseIndex(reduced_hessian_.rows()));
  batches_.ForEachPoint([&](std::size_t p) { LinearizePoint(p); });
  LinearizeMotion();
  if (problem_.scale_frame >= problem_.fixed_frames) LinearizeScale();
}

/// The residual is |t| / held distance - 1; a left rotation moves t at right angles to itself and does not change it.
void NormalEquations::LinearizeScale() {
  const Eigen::Vector3d t = ScaleBaseline(problem_);
  const double norm = std::max(t.norm(), kMinDiagonal);
  Eigen::Matrix<double, 1, 6> J_error_pose = Eigen::Matrix<double, 1, 6>::Zero();
  J_error_pose.head<3>() = kScaleWeightPx / held_distance_ * t.transpose() / norm;
  const int row = problem_.scale_frame - problem_.fixed_frames;
  pose_hessian_.block(row, row) += J_error_pose.transpose() * J_error_pose;
  pose_gradient_.segment<6>(PoseIndex(row)) +=
      J_error_pose.transpose() * kScaleWeightPx * (norm / held_distance_ - 1.0);
}

void NormalEquations::LinearizeMotion() {
  const MotionPrior& motion = problem_.motion;
  for (std::size_t i = 1; i + 1 < motion.times_s.size(); ++i) {
    const VelocityChange change = LinearizeVelocityChange(problem_.T_cam_world, motion.times_s, i);
    const std::array jacobians = {change.J_previous, change.J_current, change.J_next};
    for (const auto& [part, px] :
         {std::pair(0, motion.translation_weight_px), std::pair(3, motion.rotation_weight_px)}) {
      const Eigen::Vector3d error = px * change.value.segment<3>(part);
      const double weight = CauchyWeight(error.squaredNorm() / (noise_.cauchy_width_px * noise_.cauchy_width_px));
      for (int k = 0; k < 3; ++k) {
        const int row = static_cast<int>(i) - 1 + k - problem_.fixed_frames;
        if (row < 0) continue;
        const Eigen::Matrix<double, 6, 3> weighted = weight * px * jacobians[k].middleRows<3>(part).transpose();
        pose_gradient_.segment<6>(PoseIndex(row)).noalias() += weighted * error;
        for (int l = 0; l <= k; ++l) {
          const int column = row - k + l;
          if (column < 0) continue;
          pose_hessian_.block(row, column).noalias() += weighted * (px * jacobians[l].middleRows<3>(part));
        }
      }
    }
  }
}

void NormalEquations::LinearizePoint(std::size_t p) {
  PointPart& point = points_[p];
  point.hessian.setZero();
  point.gradient.setZero();
  thread_local LinearizedTrack track;
  track.Linearize(problem_, noise_, begin_[p], begin_[p + 1]);
  for (std::size_t i = begin_[p]; i < begin_[p + 1]; ++i) {
    const std::size_t k = i - begin_[p];
    const LinearizedReprojection& reprojection = track.observation(k);
    const auto weighted = track.ComputeWeightedRow(k);
    point.hessian.noalias() += reprojection.J_error_point.transpose().lazyProduct(weighted.J_error_point);
    point.gradient.noalias() += reprojection.J_error_point.transpose() * weighted.error;
    ObservationPart& observation = observations_[i];
    observation.pose_point_hessian.setZero();
    const int row = PoseRow(i);
    if (row < 0) continue;
    const Eigen::Matrix<double, 6, 2> J_transposed = reprojection.J_error_pose.transpose();
    observation.pose_gradient.noalias() = J_transposed * weighted.error;
    pose_gradient_.segment<6>(PoseIndex(row)) += observation.pose_gradient;
    observation.pose_point_hessian.noalias() = J_transposed.lazyProduct(weighted.J_error_point);
    for (std::size_t l = 0; l <= k; ++l) {
      const double weight = track.hessian_weight(k, l);
      const int column = PoseRow(begin_[p] + l);
      if (weight == 0.0 || column < 0) continue;
      const Eigen::Matrix<double, 6, 2> weighted_transposed = weight * J_transposed;
      pose_hessian_.block(row, column).noalias() += weighted_transposed.lazyProduct(track.observation(l).J_error_pose);
    }
  }
}

void NormalEquations::Reduce(double lambda, Eigen::VectorXd* right) {
  reduced_hessian_ = pose_hessian_;
  *right = -pose_gradient_;
  for (int i = 0; i < reduced_hessian_.rows(); ++i) {
    reduced_hessian_.block(i, i).diagonal() *= 1.0 + lambda;
    reduced_hessian_.block(i, i).diagonal().array() += kMinDiagonal;
  }
  batches_.ForEachPoint([&](std::size_t p) { EliminatePoint(p, lambda, right); });
}

bool NormalEquations::Factorize() {
  Eigen::VectorXd right;
  Reduce(0.0, &right);
  return reduced_hessian_.Factorize();
}

Eigen::VectorXd NormalEquations::SolveWithSigns(const std::vector<double>& signs) const {
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(PoseIndex(reduced_hessian_.rows()));
  for (std::size_t i = 0; i < observations_.size(); ++i) {
    if (PoseRow(i) < 0) continue;
    // The step of a point that is not at its own minimum is not an error of the poses.
    const auto p = static_cast<std::size_t>(problem_.observations[i].point);
    gradient.segment<6>(PoseIndex(PoseRow(i))) +=
        signs[p] * (observations_[i].pose_gradient -
                    observations_[i].pose_point_hessian * (points_[p].inverse_hessian * points_[p].gradient));
  }
  return reduced_hessian_.Solve(-gradient);
}

bool NormalEquations::Solve(double lambda, Eigen::VectorXd* pose_steps, std::vector<Eigen::Vector3d>* point_steps) {
  Eigen::VectorXd right;
  Reduce(lambda, &right);
  if (!reduced_hessian_.Factorize()) return false;
  *pose_steps = reduced_hessian_.Solve(right);
  point_steps->resize(points_.size());
  for (std::size_t p = 0; p < points_.size(); ++p) {
    Eigen::Vector3d sum = -points_[p].gradient;
    for (std::size_t i = begin_[p]; i < begin_[p + 1]; ++i) {
      const int row = PoseRow(i);
      if (row < 0) continue;
      sum.noalias() -= observations_[i].pose_point_hessian.transpose() * pose_steps->segment<6>(PoseIndex(row));
    }
    (*point_steps)[p] = points_[p].inverse_hessian * sum;
  }
  return pose_steps->allFinite();
}

void NormalEquations::EliminatePoint(std::size_t p, double lambda, Eigen::VectorXd* right) {
  PointPart& point = points_[p];
  Eigen::Matrix3d damped = point.hessian;
  damped.diagonal() *= 1.0 + lambda;
  damped.diagonal().array() += kPointDamping * damped.diagonal().maxCoeff() + kMinDiagonal;
  point.inverse_hessian = damped.inverse();
  for (std::size_t i = begin_[p]; i < begin_[p + 1]; ++i) {
    const int row = PoseRow(i);
    if (row < 0) continue;
    const Eigen::Matrix<double, 6, 3> scaled = observations_[i].pose_point_hessian * point.inverse_hessian;
    right->segment<6>(PoseIndex(row)).noalias() += scaled * point.gradient;
    for (std::size_t j = begin_[p]; j <= i; ++j) {
      const int column = PoseRow(j);
      if (column < 0) continue;
      reduced_hessian_.block(row, column).noalias() -=
          scaled.lazyProduct(observations_[j].pose_point_hessian.transpose());
    }
  }
}

}  // namespace evo::odometry
