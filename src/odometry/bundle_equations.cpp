#include "odometry/bundle_equations.hpp"

#include <Eigen/LU>
#include <algorithm>

namespace evo {

namespace {

constexpr double kScalePrior = 1e3;       // px: what doubling the scale would cost
constexpr double kPointDamping = 1e-9;    // of a point's largest entry: points on the path have no depth
constexpr double kSmallestEntry = 1e-12;  // keeps a pose or point that nothing sees from being singular

/// From the first camera to the one that holds the scale.
Eigen::Vector3d ScaleBaseline(const BundleProblem& problem) {
  return (problem.T_cam_world[problem.scale_frame] * problem.T_cam_world.front().Inverse()).translation();
}

}  // namespace

BundleEquations::BundleEquations(const BundleProblem& problem, double loss_px, const std::vector<std::size_t>& begin)
    : problem_(problem),
      width_(loss_px),
      begin_(begin),
      scale_length_(problem.scale_frame < 0 ? 1.0 : ScaleBaseline(problem).norm()),
      reduced_(BundleSkyline(problem)),
      pose_blocks_(static_cast<std::size_t>(reduced_.rows())),
      cross_(problem.observations.size()),
      point_blocks_(problem.points.size()),
      inverses_(problem.points.size()),
      point_gradients_(problem.points.size()) {}

void BundleEquations::Linearize() {
  std::ranges::fill(pose_blocks_, BlockSkyline::Block::Zero());
  pose_gradient_ = Eigen::VectorXd::Zero(Eigen::Index{6} * reduced_.rows());
  for (std::size_t p = 0; p < problem_.points.size(); ++p) LinearizePoint(p);
  if (problem_.scale_frame >= problem_.fixed_frames) LinearizeScale();
}

/// The error (|t| / length - 1) of the held distance; a left turn moves t across itself and does not change it.
void BundleEquations::LinearizeScale() {
  const Eigen::Vector3d t = ScaleBaseline(problem_);
  const double norm = std::max(t.norm(), kSmallestEntry);
  Eigen::Matrix<double, 1, 6> by_pose = Eigen::Matrix<double, 1, 6>::Zero();
  by_pose.head<3>() = kScalePrior / scale_length_ * t.transpose() / norm;
  const int pose = problem_.scale_frame - problem_.fixed_frames;
  pose_blocks_[pose] += by_pose.transpose() * by_pose;
  pose_gradient_.segment<6>(Eigen::Index{6} * pose) += by_pose.transpose() * kScalePrior * (norm / scale_length_ - 1.0);
}

void BundleEquations::LinearizePoint(std::size_t p) {
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
    pose_gradient_.segment<6>(Eigen::Index{6} * pose).noalias() += turned * jacobian.error;
    cross_[i].noalias() = turned.lazyProduct(jacobian.by_point);
  }
}

bool BundleEquations::Solve(double lambda, Eigen::VectorXd* pose_steps, std::vector<Eigen::Vector3d>* point_steps) {
  reduced_.SetZero();
  Eigen::VectorXd right = -pose_gradient_;
  for (int i = 0; i < reduced_.rows(); ++i) {
    reduced_.At(i, i) = pose_blocks_[i];
    reduced_.At(i, i).diagonal() *= 1.0 + lambda;
    reduced_.At(i, i).diagonal().array() += kSmallestEntry;
  }
  for (std::size_t p = 0; p < problem_.points.size(); ++p) EliminatePoint(p, lambda, &right);
  if (!reduced_.Factorize()) return false;
  *pose_steps = reduced_.Solve(right);
  point_steps->resize(problem_.points.size());
  for (std::size_t p = 0; p < problem_.points.size(); ++p) {
    Eigen::Vector3d sum = -point_gradients_[p];
    for (std::size_t i = begin_[p]; i < begin_[p + 1]; ++i) {
      const int pose = Pose(i);
      if (pose >= 0) sum.noalias() -= cross_[i].transpose() * pose_steps->segment<6>(Eigen::Index{6} * pose);
    }
    (*point_steps)[p] = inverses_[p] * sum;
  }
  return pose_steps->allFinite();
}

void BundleEquations::EliminatePoint(std::size_t p, double lambda, Eigen::VectorXd* right) {
  Eigen::Matrix3d damped = point_blocks_[p];
  damped.diagonal() *= 1.0 + lambda;
  damped.diagonal().array() += kPointDamping * damped.diagonal().maxCoeff() + kSmallestEntry;
  inverses_[p] = damped.inverse();
  for (std::size_t i = begin_[p]; i < begin_[p + 1]; ++i) {
    const int row = Pose(i);
    if (row < 0) continue;
    const Eigen::Matrix<double, 6, 3> scaled = cross_[i] * inverses_[p];
    right->segment<6>(Eigen::Index{6} * row).noalias() += scaled * point_gradients_[p];
    for (std::size_t j = begin_[p]; j <= i; ++j) {
      const int column = Pose(j);
      if (column >= 0) reduced_.At(row, column).noalias() -= scaled.lazyProduct(cross_[j].transpose());
    }
  }
}

}  // namespace evo
