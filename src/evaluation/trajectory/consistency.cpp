#include "evo/evaluation/consistency.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <vector>

namespace evo::evaluation {

namespace {

constexpr double kCertain = 1e-24;  // variance that is none

/// x^T C^-1 x for one degree of freedom.
template <int kRows>
double Normalized(const Eigen::Matrix<double, kRows, 1>& error, const Eigen::Matrix<double, kRows, kRows>& covariance) {
  return error.dot(covariance.ldlt().solve(error)) / kRows;
}

struct KnownPose {
  PosePair pair;
  geometry::Matrix6d covariance;

  bool is_certain() const { return covariance.trace() < kCertain; }
};

/// For one degree of freedom.
struct SquaredErrors {
  std::vector<double> translation, rotation, pose;
};

/// Of poses whose covariances are relative to `origin`.
void Append(std::span<const KnownPose> poses, const KnownPose& origin, bool fit_scale, SquaredErrors* errors) {
  // The truth in the world of the estimate, whose axes are those of the covariances.
  const geometry::SE3 T_estimate_truth = origin.pair.T_world_cam_estimate * origin.pair.T_world_cam_truth.Inverse();
  const Eigen::Vector3d start = origin.pair.T_world_cam_estimate.translation();
  double products = 0.0, squares = 0.0;
  for (const auto& [pair, covariance] : poses) {
    const Eigen::Vector3d way = (T_estimate_truth * pair.T_world_cam_truth).translation() - start;
    products += way.dot(pair.T_world_cam_estimate.translation() - start);
    squares += way.squaredNorm();
  }
  const double scale = fit_scale && squares > 0.0 ? products / squares : 1.0;
  for (const auto& pose : poses) {
    if (pose.is_certain()) continue;
    const auto& [pair, covariance] = pose;
    const geometry::SE3 truth = T_estimate_truth * pair.T_world_cam_truth;
    geometry::Vector6d error;
    error << pair.T_world_cam_estimate.translation() - start - scale * (truth.translation() - start),
        geometry::so3::Log(pair.T_world_cam_estimate.rotation() * truth.rotation().conjugate());
    errors->translation.push_back(Normalized<3>(error.head<3>(), covariance.topLeftCorner<3, 3>()));
    errors->rotation.push_back(Normalized<3>(error.tail<3>(), covariance.bottomRightCorner<3, 3>()));
    errors->pose.push_back(Normalized<6>(error, covariance));
  }
}

}  // namespace

Consistency MeasureConsistency(std::span<const PosePair> pairs,
                               std::span<const geometry::StampedCovariance> covariances, bool fit_scale) {
  std::vector<KnownPose> known;
  for (const PosePair& pair : pairs) {
    const auto found = std::ranges::lower_bound(covariances, pair.t_estimate, {}, &geometry::StampedCovariance::t);
    if (found != covariances.end() && found->t == pair.t_estimate) known.push_back({pair, found->covariance});
  }
  SquaredErrors errors;
  auto origin = std::ranges::find_if(known, &KnownPose::is_certain);
  for (auto begin = known.begin(); origin != known.end(); begin = origin) {
    const auto next = std::find_if(origin + 1, known.end(), [](const KnownPose& pose) { return pose.is_certain(); });
    Append({begin, next}, *origin, fit_scale, &errors);
    origin = next;
  }
  return {ComputeStatistics(errors.translation), ComputeStatistics(errors.rotation), ComputeStatistics(errors.pose)};
}

}  // namespace evo::evaluation
