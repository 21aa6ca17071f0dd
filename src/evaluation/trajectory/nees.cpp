#include "evaluation/trajectory/nees.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <vector>

namespace evo::evaluation {

namespace {

constexpr double kZeroVariance = 1e-24;  // trace of a covariance that is zero but for rounding

/// e^T C^-1 e / n.
template <int kRows>
double NormalizedSquaredError(const Eigen::Matrix<double, kRows, 1>& error,
                              const Eigen::Matrix<double, kRows, kRows>& covariance) {
  return error.dot(covariance.ldlt().solve(error)) / kRows;
}

struct PairWithCovariance {
  PosePair pair;
  geometry::Matrix6d covariance;

  bool is_origin() const { return covariance.trace() < kZeroVariance; }
};

struct NormalizedErrors {
  std::vector<double> translation, rotation, pose;
};

/// Appends the errors of poses whose covariances are relative to `origin`.
void Append(std::span<const PairWithCovariance> poses, const PairWithCovariance& origin, bool fit_scale,
            NormalizedErrors* errors) {
  // The covariances are given in the axes of the estimate's world frame.
  const geometry::SE3 T_estimate_truth = origin.pair.T_world_cam_estimate * origin.pair.T_world_cam_truth.Inverse();
  const Eigen::Vector3d p_origin = origin.pair.T_world_cam_estimate.translation();
  double products = 0.0, squares = 0.0;
  for (const auto& [pair, covariance] : poses) {
    const Eigen::Vector3d path = (T_estimate_truth * pair.T_world_cam_truth).translation() - p_origin;
    products += path.dot(pair.T_world_cam_estimate.translation() - p_origin);
    squares += path.squaredNorm();
  }
  const double scale = fit_scale && squares > 0.0 ? products / squares : 1.0;
  for (const auto& pose : poses) {
    if (pose.is_origin()) continue;
    const auto& [pair, covariance] = pose;
    const geometry::SE3 truth = T_estimate_truth * pair.T_world_cam_truth;
    geometry::Vector6d error;
    error << pair.T_world_cam_estimate.translation() - p_origin - scale * (truth.translation() - p_origin),
        geometry::so3::Log(pair.T_world_cam_estimate.rotation() * truth.rotation().conjugate());
    errors->translation.push_back(NormalizedSquaredError<3>(error.head<3>(), covariance.topLeftCorner<3, 3>()));
    errors->rotation.push_back(NormalizedSquaredError<3>(error.tail<3>(), covariance.bottomRightCorner<3, 3>()));
    errors->pose.push_back(NormalizedSquaredError<6>(error, covariance));
  }
}

}  // namespace

Nees ComputeNees(std::span<const PosePair> pairs, std::span<const geometry::StampedCovariance> covariances,
                 bool fit_scale) {
  std::vector<PairWithCovariance> known;
  for (const PosePair& pair : pairs) {
    const auto found = std::ranges::lower_bound(covariances, pair.t_estimate, {}, &geometry::StampedCovariance::t);
    if (found != covariances.end() && found->t == pair.t_estimate) known.push_back({pair, found->covariance});
  }
  NormalizedErrors errors;
  auto origin = std::ranges::find_if(known, &PairWithCovariance::is_origin);
  for (auto begin = known.begin(); origin != known.end(); begin = origin) {
    const auto next =
        std::find_if(origin + 1, known.end(), [](const PairWithCovariance& pose) { return pose.is_origin(); });
    Append({begin, next}, *origin, fit_scale, &errors);
    origin = next;
  }
  return {ComputeStatistics(errors.translation), ComputeStatistics(errors.rotation), ComputeStatistics(errors.pose)};
}

}  // namespace evo::evaluation
