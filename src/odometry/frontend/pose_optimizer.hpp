#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "evo/geometry/se3.hpp"
#include "evo/odometry/odometry_options.hpp"

namespace evo::odometry {

/// A point of the map and its feature in the frame.
struct PoseObservation {
  Eigen::Vector3d point_world;
  Eigen::Vector2d x;                   ///< undistorted, on the normalized plane z = 1
  Eigen::Matrix2d J_pixel_normalized;  ///< see Feature
};

struct PoseEstimate {
  geometry::SE3 T_cam_world;
  std::vector<bool> inliers;  ///< of the observations
  int inlier_count = 0;
  double scale_px = 0.0;  ///< robust standard deviation of a coordinate of the residuals
  /// Of the left twist (translation, rotation) of T_cam_world; zero if the pose is not determined.
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();
};

/// The residual e = u - (1/Z) K exp(xi^) P (D. Zhu, equation 1) in raw pixels, to first order about the observation.
/// Infinite behind the camera.
Eigen::Vector2d ReprojectionError(const geometry::SE3& T_cam_world, const PoseObservation& observation);
/// The Jacobian of the residual by delta in T <- Exp(delta) T (equation 2).
Eigen::Matrix<double, 2, 6> ReprojectionJacobian(const geometry::SE3& T_cam_world, const PoseObservation& observation);

/// Estimates the pose of one frame against known points by Gauss-Newton on the weighted normal equations (D. Zhu,
/// equations 3-5; the paper omits the transpose of J on the right of 4 and 5). The weights w_i are Tukey's with the
/// scale of the residuals' median. The first iterations use Huber's, which do not need a good start.
class PoseOptimizer {
 public:
  explicit PoseOptimizer(const PoseOptions& options) : options_(options) {}

  /// With fewer than three observations the result is the initial pose without inliers.
  PoseEstimate Optimize(std::span<const PoseObservation> observations, const geometry::SE3& T_cam_world_initial) const;

  /// Whether the estimate has enough inliers.
  bool Accepts(const PoseEstimate& estimate) const { return Accepts(estimate, options_.min_inlier_ratio); }
  bool Accepts(const PoseEstimate& estimate, double min_inlier_ratio) const;

 private:
  /// Minimises the cost from `T_cam_world`; returns the last normal matrix.
  geometry::Matrix6d Minimize(std::span<const PoseObservation> observations, geometry::SE3* T_cam_world) const;

  PoseOptions options_;
};

}  // namespace evo::odometry
