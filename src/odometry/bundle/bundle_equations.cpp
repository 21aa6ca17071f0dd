#include "odometry/bundle/bundle_equations.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace evo::odometry {

namespace {

constexpr double kScalePrior = 1e3;         // px: what doubling the scale would cost
constexpr double kPointDamping = 1e-9;      // of a point's largest entry: points on the path have no depth
constexpr std::size_t kFewestInBatch = 64;  // points: fewer are not worth a thread's while
constexpr double kSmallestEntry = 1e-12;    // keeps a pose or point that nothing sees from being singular

/// From the first camera to the one that holds the scale.
Eigen::Vector3d ScaleBaseline(const BundleProblem& problem) {
  return (problem.T_cam_world[problem.scale_frame] * problem.T_cam_world.front().Inverse()).translation();
}

/// Batches of points in order, of which none shares a pose with the next but one. So every other batch may be worked on
/// at once, and every pose gets its terms in the same order whatever the number of threads.
std::vector<std::size_t> CutIntoBatches(const BundleProblem& problem, const std::vector<std::size_t>& begin) {
  const std::size_t count = problem.points.size();
  std::vector<int> earliest(count + 1, std::numeric_limits<int>::max());  // frame of this point and all after it
  for (std::size_t p = count; p-- > 0;) {
    earliest[p] = earliest[p + 1];
    if (begin[p] < begin[p + 1]) earliest[p] = std::min(earliest[p], problem.observations[begin[p]].frame);
  }
  std::vector<std::size_t> batches = {0};
  int last_before = -1;  // frame of the batch before the present one
  int last = -1;
  for (std::size_t p = 0; p < count; ++p) {
    if (p - batches.back() >= kFewestInBatch && earliest[p] > last_before) {
      batches.push_back(p);
      last_before = std::exchange(last, -1);
    }
    if (begin[p] < begin[p + 1]) last = std::max(last, problem.observations[begin[p + 1] - 1].frame);
  }
  batches.push_back(count);
  return batches;
}

}  // namespace

void TrackEquations::Linearize(const BundleProblem& problem, const ErrorModel& model, std::size_t begin,
                               std::size_t end) {
  const std::size_t count = end - begin;
  sightings.resize(count);
  errors_.resize(count);
  weights_.resize(count);
  if (count == 0) return;
  const BundlePoint& point = problem.points[problem.observations[begin].point];
  const geometry::SE3 T_world_anchor = problem.T_cam_world[point.anchor].Inverse();
  for (std::size_t k = 0; k < count; ++k) {
    const auto& observation = problem.observations[begin + k];
    const geometry::SE3 T_cam_anchor = problem.T_cam_world[observation.frame] * T_world_anchor;
    const bool visible = evo::odometry::Linearize(T_cam_anchor, point.inverse_depth, observation, &sightings[k]);
    if (!visible) sightings[k] = {};
    weights_[k] = visible ? 1.0 : 0.0;
    errors_[k] = sightings[k].error;
  }
  const auto steps = model.Steps(begin, end);
  Innovate(steps, errors_, &innovations_);
  for (std::size_t k = 0; k < count; ++k) weights_[k] *= CauchyWeight(innovations_[k].squaredNorm(), model.loss_px);
  InformationOfErrors(steps, weights_, &information);
  has_curvature_ = model.curvature;
  if (!has_curvature_) return;
  // Cauchy's loss in two dimensions has the second derivatives w and w (2 w - 1), of mean w^2, for its weight w.
  for (double& weight : weights_) weight *= weight;
  InformationOfErrors(steps, weights_, &curvature_);
}

Eigen::Vector2d TrackEquations::Weighted(std::size_t i, Eigen::Matrix<double, 2, 3>* by_point) const {
  Eigen::Vector2d error = Eigen::Vector2d::Zero();
  by_point->setZero();
  for (std::size_t j = 0; j < sightings.size(); ++j) {
    const auto row = static_cast<Eigen::Index>(j);
    const auto column = static_cast<Eigen::Index>(i);
    if (information(row, column) == 0.0) continue;
    error += information(row, column) * sightings[j].error;
    *by_point += curvature()(row, column) * sightings[j].by_point;
  }
  return error;
}

BundleEquations::BundleEquations(const BundleProblem& problem, const ErrorModel& model,
                                 const std::vector<std::size_t>& begin, ThreadPool* pool)
    : problem_(problem),
      model_(model),
      begin_(begin),
      pool_(pool),
      batches_(CutIntoBatches(problem, begin)),
      scale_length_(problem.scale_frame < 0 ? 1.0 : ScaleBaseline(problem).norm()),
      poses_(BundleSkyline(problem)),
      reduced_(poses_),
      cross_(problem.observations.size()),
      pulls_(problem.observations.size(), geometry::Vector6d::Zero()),
      point_blocks_(problem.points.size()),
      inverses_(problem.points.size()),
      point_gradients_(problem.points.size()) {}

void BundleEquations::ForEachPoint(const std::function<void(std::size_t)>& work) {
  const std::size_t count = batches_.size() - 1;
  for (std::size_t first = 0; first < 2; ++first) {
    ForEachIndex(pool_, (count + 1 - first) / 2, 1, [&](std::size_t i) {
      for (std::size_t p = batches_[first + 2 * i]; p < batches_[first + 2 * i + 1]; ++p) work(p);
    });
  }
}

void BundleEquations::Linearize() {
  poses_.SetZero();
  pose_gradient_ = Eigen::VectorXd::Zero(Eigen::Index{6} * reduced_.rows());
  ForEachPoint([&](std::size_t p) { LinearizePoint(p); });
  LinearizeMotion();
  if (problem_.scale_frame >= problem_.fixed_frames) LinearizeScale();
}

/// The error (|t| / length - 1) of the held distance; a left turn moves t across itself and does not change it.
void BundleEquations::LinearizeScale() {
  const Eigen::Vector3d t = ScaleBaseline(problem_);
  const double norm = std::max(t.norm(), kSmallestEntry);
  Eigen::Matrix<double, 1, 6> by_pose = Eigen::Matrix<double, 1, 6>::Zero();
  by_pose.head<3>() = kScalePrior / scale_length_ * t.transpose() / norm;
  const int pose = problem_.scale_frame - problem_.fixed_frames;
  poses_.At(pose, pose) += by_pose.transpose() * by_pose;
  pose_gradient_.segment<6>(Eigen::Index{6} * pose) += by_pose.transpose() * kScalePrior * (norm / scale_length_ - 1.0);
}

void BundleEquations::LinearizeMotion() {
  const MotionPrior& motion = problem_.motion;
  for (std::size_t i = 1; i + 1 < motion.t.size(); ++i) {
    const VelocityChange change = LinearizeVelocityChange(problem_.T_cam_world, motion.t, i);
    const std::array derivatives = {change.by_before, change.by_here, change.by_after};
    for (const auto& [rows, px] : {std::pair(0, motion.translation_px), std::pair(3, motion.rotation_px)}) {
      const Eigen::Vector3d error = px * change.value.segment<3>(rows);
      const double weight = CauchyWeight(error.squaredNorm(), model_.loss_px);
      for (int k = 0; k < 3; ++k) {
        const int row = static_cast<int>(i) - 1 + k - problem_.fixed_frames;
        if (row < 0) continue;
        const Eigen::Matrix<double, 6, 3> turned = weight * px * derivatives[k].middleRows<3>(rows).transpose();
        pose_gradient_.segment<6>(Eigen::Index{6} * row).noalias() += turned * error;
        for (int l = 0; l <= k; ++l) {
          const int column = row - k + l;
          if (column < 0) continue;
          poses_.At(row, column).noalias() += turned * (px * derivatives[l].middleRows<3>(rows));
        }
      }
    }
  }
}

void BundleEquations::LinearizePoint(std::size_t p) {
  point_blocks_[p].setZero();
  point_gradients_[p].setZero();
  thread_local TrackEquations track;
  track.Linearize(problem_, model_, begin_[p], begin_[p + 1]);
  Eigen::Matrix<double, 2, 3> by_point;
  for (std::size_t i = begin_[p]; i < begin_[p + 1]; ++i) {
    const std::size_t k = i - begin_[p];
    const BundleJacobian& sighting = track.sightings[k];
    const Eigen::Vector2d error = track.Weighted(k, &by_point);
    point_blocks_[p].noalias() += sighting.by_point.transpose().lazyProduct(by_point);
    point_gradients_[p].noalias() += sighting.by_point.transpose() * error;
    cross_[i].setZero();
    const int row = Pose(i);
    if (row < 0) continue;
    const Eigen::Matrix<double, 6, 2> turned = sighting.by_pose.transpose();
    pulls_[i].noalias() = turned * error;
    pose_gradient_.segment<6>(Eigen::Index{6} * row) += pulls_[i];
    cross_[i].noalias() = turned.lazyProduct(by_point);
    for (std::size_t l = 0; l <= k; ++l) {
      const double curvature = track.curvature()(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(l));
      const int column = Pose(begin_[p] + l);
      if (curvature == 0.0 || column < 0) continue;
      const Eigen::Matrix<double, 6, 2> weighted = curvature * turned;
      poses_.At(row, column).noalias() += weighted.lazyProduct(track.sightings[l].by_pose);
    }
  }
}

void BundleEquations::Reduce(double lambda, Eigen::VectorXd* right) {
  reduced_ = poses_;
  *right = -pose_gradient_;
  for (int i = 0; i < reduced_.rows(); ++i) {
    reduced_.At(i, i).diagonal() *= 1.0 + lambda;
    reduced_.At(i, i).diagonal().array() += kSmallestEntry;
  }
  ForEachPoint([&](std::size_t p) { EliminatePoint(p, lambda, right); });
}

bool BundleEquations::Factorize() {
  Eigen::VectorXd right;
  Reduce(0.0, &right);
  return reduced_.Factorize();
}

Eigen::VectorXd BundleEquations::StepsIf(const std::vector<double>& signs) const {
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(Eigen::Index{6} * reduced_.rows());
  for (std::size_t i = 0; i < pulls_.size(); ++i) {
    if (Pose(i) < 0) continue;
    // What the point's own gradient would move the poses by is not an error of theirs.
    const auto p = static_cast<std::size_t>(problem_.observations[i].point);
    gradient.segment<6>(Eigen::Index{6} * Pose(i)) +=
        signs[p] * (pulls_[i] - cross_[i] * (inverses_[p] * point_gradients_[p]));
  }
  return reduced_.Solve(-gradient);
}

bool BundleEquations::Solve(double lambda, Eigen::VectorXd* pose_steps, std::vector<Eigen::Vector3d>* point_steps) {
  Eigen::VectorXd right;
  Reduce(lambda, &right);
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

}  // namespace evo::odometry
