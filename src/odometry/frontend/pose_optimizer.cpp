#include "odometry/frontend/pose_optimizer.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "evo/core/median.hpp"
#include "evo/core/robust.hpp"

namespace evo::odometry {

namespace {

constexpr std::size_t kMinObservations = 3;  // two equations each for six unknowns
constexpr int kHuberIterations = 3;          // enough to come within reach of Tukey's weights
constexpr double kMinScalePx = 0.2;          // a chance fit of few points must not reject the next
constexpr double kMaxScalePx = 5.0;          // a bad start must not make every observation an inlier
constexpr double kOutlierSigmas = 4.0;       // a Gaussian error exceeds it in 2-d once in 3000
constexpr double kDamping = 1e-9;            // relative; keeps a direction without information solvable
constexpr double kMinStep2 = 1e-18;          // squared norm of a twist: rounding

/// Standard deviation of a coordinate, from the median norm of the residuals.
double RobustScale(std::vector<double> norms) {
  return std::clamp(kMedianNormToSigma * Median(std::move(norms)), kMinScalePx, kMaxScalePx);
}

std::vector<double> ResidualNorms(std::span<const PoseObservation> observations, const geometry::SE3& T_cam_world) {
  std::vector<double> norms(observations.size());
  for (std::size_t i = 0; i < observations.size(); ++i) {
    norms[i] = ReprojectionError(T_cam_world, observations[i]).norm();
  }
  return norms;
}

}  // namespace

Eigen::Vector2d ReprojectionError(const geometry::SE3& T_cam_world, const PoseObservation& observation) {
  const Eigen::Vector3d p = T_cam_world * observation.point_world;
  if (!(p.z() > 0.0)) return Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  return observation.J_pixel_normalized * (observation.x - p.head<2>() / p.z());
}

Eigen::Matrix<double, 2, 6> ReprojectionJacobian(const geometry::SE3& T_cam_world, const PoseObservation& observation) {
  const Eigen::Vector3d p = T_cam_world * observation.point_world;
  const double inverse_z = 1.0 / p.z();
  const double u = p.x() * inverse_z;
  const double v = p.y() * inverse_z;
  // -(1/z) [1 0 -u; 0 1 -v] [I, -p^]; negative because the error subtracts the projection.
  Eigen::Matrix<double, 2, 6> jacobian;
  jacobian << -inverse_z, 0, u * inverse_z, u * v, -1.0 - u * u, v, 0, -inverse_z, v * inverse_z, 1.0 + v * v, -u * v,
      -u;
  return observation.J_pixel_normalized * jacobian;
}

geometry::Matrix6d PoseOptimizer::Minimize(std::span<const PoseObservation> observations,
                                           geometry::SE3* T_cam_world) const {
  geometry::Matrix6d normal;
  for (int iteration = 0; iteration < options_.iterations; ++iteration) {
    const double scale = RobustScale(ResidualNorms(observations, *T_cam_world));
    normal.setZero();
    geometry::Vector6d gradient = geometry::Vector6d::Zero();
    for (const auto& observation : observations) {
      const Eigen::Vector2d error = ReprojectionError(*T_cam_world, observation);  // equation 1
      if (!error.allFinite()) continue;
      const double weight = iteration < kHuberIterations ? HuberWeight(error.norm(), kHuberWidth * scale)
                                                         : TukeyWeight(error.norm(), kTukeyWidth * scale);
      const Eigen::Matrix<double, 2, 6> jacobian = ReprojectionJacobian(*T_cam_world, observation);  // equation 2
      normal += weight * jacobian.transpose() * jacobian;                                            // equation 5
      gradient += weight * jacobian.transpose() * error;
    }
    normal.diagonal() *= 1.0 + kDamping;
    const geometry::Vector6d step = -normal.ldlt().solve(gradient);
    if (!step.allFinite()) break;
    *T_cam_world = geometry::SE3::Exp(step) * *T_cam_world;
    if (iteration > kHuberIterations && step.squaredNorm() < kMinStep2) break;
  }
  return normal;
}

PoseEstimate PoseOptimizer::Optimize(std::span<const PoseObservation> observations,
                                     const geometry::SE3& T_cam_world_initial) const {
  PoseEstimate result{.T_cam_world = T_cam_world_initial, .inliers = std::vector<bool>(observations.size())};
  if (observations.size() < kMinObservations) return result;
  const geometry::Matrix6d normal = Minimize(observations, &result.T_cam_world);
  const auto norms = ResidualNorms(observations, result.T_cam_world);
  result.scale_px = RobustScale(norms);
  const double limit = std::clamp(kOutlierSigmas * result.scale_px, options_.inlier_px, 2.0 * options_.inlier_px);
  for (std::size_t i = 0; i < norms.size(); ++i) {
    result.inliers[i] = norms[i] < limit;
    if (result.inliers[i]) ++result.inlier_count;
  }
  const Eigen::LDLT<geometry::Matrix6d> solver(normal);
  if (solver.info() == Eigen::Success && solver.vectorD().minCoeff() > 0.0) {
    result.covariance = result.scale_px * result.scale_px * solver.solve(geometry::Matrix6d::Identity());
  }
  return result;
}

bool PoseOptimizer::Accepts(const PoseEstimate& estimate, double min_inlier_ratio) const {
  return estimate.inlier_count >= options_.min_inliers &&
         estimate.inlier_count >= min_inlier_ratio * static_cast<double>(estimate.inliers.size());
}

}  // namespace evo::odometry
