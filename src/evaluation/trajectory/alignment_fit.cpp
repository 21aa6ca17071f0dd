#include "evaluation/trajectory/alignment_fit.hpp"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "evo/core/error.hpp"

namespace evo::evaluation {

namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

Error Degenerate(const std::string& alignment, const std::string& what, const std::string& remedy) {
  return {ErrorKind::kDegenerateAlignment, fmt::format("alignment '{}': {}; {}", alignment, what, remedy)};
}

geometry::SE3 FitFirstPose(const PosePair& first) {
  return first.T_world_cam_truth * first.T_world_cam_estimate.Inverse();
}

Similarity FitOriginAndScale(std::span<const PosePair> pairs, const std::string& name) {
  const geometry::SE3& T_world_cam_first = pairs.front().T_world_cam_truth;
  const geometry::SE3 T_truth_estimate = FitFirstPose(pairs.front());
  double cross = 0.0;
  double square = 0.0;
  for (const auto& pair : pairs) {
    const Eigen::Vector3d moved =
        T_truth_estimate * pair.T_world_cam_estimate.translation() - T_world_cam_first.translation();
    cross += moved.dot(pair.T_world_cam_truth.translation() - T_world_cam_first.translation());
    square += moved.squaredNorm();
  }
  if (square / static_cast<double>(pairs.size()) <= kEpsilon || cross <= 0.0) {
    throw Degenerate(name, fmt::format("no positive scale fits the {} matched positions", pairs.size()),
                     "choose --align none or origin, or a longer interval with motion");
  }
  const double scale = cross / square;
  // The scaling about the first true position as a similarity about the world's origin.
  const Eigen::Vector3d origin = T_world_cam_first.translation();
  return {scale,
          geometry::SE3(T_truth_estimate.rotation(), scale * (T_truth_estimate.translation() - origin) + origin)};
}

/// Least squares over positions (S. Umeyama: Least-squares estimation of transformation parameters between two point
/// patterns, PAMI 1991, equations 38-43), with evo's check that the positions span a plane.
Similarity FitUmeyama(std::span<const PosePair> pairs, bool with_scale, const std::string& name) {
  const auto n = static_cast<double>(pairs.size());
  Eigen::Vector3d mean_estimate = Eigen::Vector3d::Zero();
  Eigen::Vector3d mean_truth = Eigen::Vector3d::Zero();
  for (const auto& pair : pairs) {
    mean_estimate += pair.T_world_cam_estimate.translation() / n;
    mean_truth += pair.T_world_cam_truth.translation() / n;
  }
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double variance_estimate = 0.0;
  for (const auto& pair : pairs) {
    const Eigen::Vector3d estimate = pair.T_world_cam_estimate.translation() - mean_estimate;
    const Eigen::Vector3d truth = pair.T_world_cam_truth.translation() - mean_truth;
    covariance += truth * estimate.transpose() / n;
    variance_estimate += estimate.squaredNorm() / n;
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d& singular = svd.singularValues();
  if (singular[1] <= kEpsilon * std::max(1.0, singular[0])) {
    throw Degenerate(name, fmt::format("the {} matched positions lie on a line or a point", pairs.size()),
                     "choose --align origin or origin-scale, or a longer interval");
  }
  Eigen::Vector3d sign(1, 1, svd.matrixU().determinant() * svd.matrixV().determinant() < 0 ? -1 : 1);
  const Eigen::Matrix3d rotation = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  const double scale = with_scale ? singular.dot(sign) / variance_estimate : 1.0;
  return {scale, geometry::SE3(Eigen::Quaterniond(rotation), mean_truth - scale * (rotation * mean_estimate))};
}

/// The angle of the rotation R about `up` that minimises the sum of |R b - a|^2 over the columns of `a` and `b`, which
/// maximises the sum of a . R b with R b = cos b + sin (up x b) + (1 - cos) (up . b) up (Rodrigues).
double BestYaw(const Eigen::Matrix3Xd& a, const Eigen::Matrix3Xd& b, const Eigen::Vector3d& up,
               const std::string& name) {
  double sine = 0.0;
  double cosine = 0.0;
  for (Eigen::Index i = 0; i < a.cols(); ++i) {
    sine += up.dot(b.col(i).cross(a.col(i)));
    cosine += a.col(i).dot(b.col(i)) - up.dot(a.col(i)) * up.dot(b.col(i));
  }
  if (std::hypot(sine, cosine) <= kEpsilon * static_cast<double>(a.cols())) {
    throw Degenerate(name, fmt::format("the {} matched positions lie on a vertical line", a.cols()),
                     "choose --align origin or posyaw:1, or a longer interval");
  }
  return std::atan2(sine, cosine);
}

Similarity FitPositionAndYaw(std::span<const PosePair> pairs, const Eigen::Vector3d& up, const std::string& name) {
  const auto n = static_cast<Eigen::Index>(pairs.size());
  Eigen::Matrix3Xd truth(3, n);
  Eigen::Matrix3Xd estimate(3, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    truth.col(i) = pairs[static_cast<std::size_t>(i)].T_world_cam_truth.translation();
    estimate.col(i) = pairs[static_cast<std::size_t>(i)].T_world_cam_estimate.translation();
  }
  const Eigen::Vector3d mean_truth = truth.rowwise().mean();
  const Eigen::Vector3d mean_estimate = estimate.rowwise().mean();
  const double yaw = n == 1 ? BestYaw(pairs.front().T_world_cam_truth.RotationMatrix(),
                                      pairs.front().T_world_cam_estimate.RotationMatrix(), up, name)
                            : BestYaw(truth.colwise() - mean_truth, estimate.colwise() - mean_estimate, up, name);
  const Eigen::Quaterniond rotation = geometry::so3::Exp(yaw * up);
  return {1.0, geometry::SE3(rotation, mean_truth - rotation * mean_estimate)};
}

/// The pairs that `alignment` is fitted to, at least one.
std::span<const PosePair> SelectPairsForFit(std::span<const PosePair> pairs, const Alignment& alignment) {
  if (alignment.first_poses) return pairs.first(std::min(*alignment.first_poses, pairs.size()));
  if (!alignment.first_seconds) return pairs;
  const TimeNs end = pairs.front().t_truth + FromSeconds(*alignment.first_seconds);
  const auto last = std::ranges::upper_bound(pairs, end, {}, &PosePair::t_truth);
  return pairs.first(static_cast<std::size_t>(last - pairs.begin()));
}

}  // namespace

Similarity FitAlignment(std::span<const PosePair> pairs, const Alignment& alignment, const Eigen::Vector3d& up) {
  using Method = Alignment::Method;
  const std::string& name = alignment.name;
  if (alignment.method == Method::kNone) return {};
  if (pairs.empty()) throw Degenerate(name, "there are no matched poses", "check that the stamps overlap");
  const auto fitted = SelectPairsForFit(pairs, alignment);
  switch (alignment.method) {
    case Method::kOrigin:
      return {1.0, FitFirstPose(pairs.front())};
    case Method::kOriginScale:
      return FitOriginAndScale(fitted, name);
    case Method::kScale:
      return {FitUmeyama(fitted, true, name).scale, geometry::SE3()};
    case Method::kPosYaw:
      return FitPositionAndYaw(fitted, up, name);
    default:
      return FitUmeyama(fitted, alignment.method == Method::kSim3, name);
  }
}

}  // namespace evo::evaluation
