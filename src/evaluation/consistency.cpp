#include "evo/evaluation/consistency.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <utility>

namespace evo {

namespace {

constexpr double kCertain = 1e-24;  // variance that is none

/// x^T C^-1 x for one degree of freedom.
template <int kRows>
double Normalized(const Eigen::Matrix<double, kRows, 1>& error, const Eigen::Matrix<double, kRows, kRows>& covariance) {
  return error.dot(covariance.ldlt().solve(error)) / kRows;
}

}  // namespace

Consistency MeasureConsistency(std::span<const PosePair> pairs, std::span<const StampedCovariance> covariances,
                               bool fit_scale) {
  std::vector<std::pair<PosePair, Matrix6d>> known;
  for (const PosePair& pair : pairs) {
    const auto found = std::ranges::lower_bound(covariances, pair.t_estimate, {}, &StampedCovariance::t);
    if (found != covariances.end() && found->t == pair.t_estimate) known.emplace_back(pair, found->covariance);
  }
  if (known.empty()) return {ComputeStatistics({}), ComputeStatistics({}), ComputeStatistics({})};
  const auto is_certain = [](const auto& pose) { return pose.second.trace() < kCertain; };
  auto origin = std::ranges::find_if(known, is_certain);
  if (origin == known.end()) origin = known.begin();

  // The truth in the world of the estimate, whose axes are those of the covariances.
  const SE3 T_estimate_truth = origin->first.T_world_cam_estimate * origin->first.T_world_cam_truth.Inverse();
  const Eigen::Vector3d start = origin->first.T_world_cam_estimate.translation();
  double products = 0.0, squares = 0.0;
  for (const auto& [pair, covariance] : known) {
    const Eigen::Vector3d way = (T_estimate_truth * pair.T_world_cam_truth).translation() - start;
    products += way.dot(pair.T_world_cam_estimate.translation() - start);
    squares += way.squaredNorm();
  }
  const double scale = fit_scale && squares > 0.0 ? products / squares : 1.0;

  std::vector<double> of_translation, of_rotation, of_pose;
  for (const auto& known_pose : known) {
    if (is_certain(known_pose)) continue;
    const auto& [pair, covariance] = known_pose;
    const SE3 truth = T_estimate_truth * pair.T_world_cam_truth;
    Vector6d error;
    error << pair.T_world_cam_estimate.translation() - start - scale * (truth.translation() - start),
        so3::Log(pair.T_world_cam_estimate.rotation() * truth.rotation().conjugate());
    of_translation.push_back(Normalized<3>(error.head<3>(), covariance.topLeftCorner<3, 3>()));
    of_rotation.push_back(Normalized<3>(error.tail<3>(), covariance.bottomRightCorner<3, 3>()));
    of_pose.push_back(Normalized<6>(error, covariance));
  }
  return {ComputeStatistics(of_translation), ComputeStatistics(of_rotation), ComputeStatistics(of_pose)};
}

}  // namespace evo
