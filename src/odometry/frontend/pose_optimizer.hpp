#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "evo/geometry/se3.hpp"
#include "evo/odometry/odometry_options.hpp"

namespace evo::odometry {

/// A point of the map and where the frame saw it.
struct PoseObservation {
  Eigen::Vector3d point_world;
  Eigen::Vector2d x;                   ///< on the plane z = 1
  Eigen::Matrix2d J_pixel_normalized;  ///< see Feature
};

struct PoseEstimate {
  geometry::SE3 T_cam_world;
  std::vector<bool> inliers;
  int inlier_count = 0;
  double scale_px = 0.0;  ///< robust standard deviation of a residual's coordinate
  double cost = 0.0;      ///< sum of the weighted squared residuals, px^2
  /// Of the left twist (translation, rotation); zero if the pose is not determined.
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();
};

/// e(xi) = u - (1/Z) K exp(xi^) P (equation 1) in raw pixels, to first order about the observation. Infinite behind the
/// camera.
Eigen::Vector2d ReprojectionError(const geometry::SE3& T_cam_world, const PoseObservation& observation);
/// de / d delta for T <- Exp(delta) T (equation 2).
Eigen::Matrix<double, 2, 6> ReprojectionJacobian(const geometry::SE3& T_cam_world, const PoseObservation& observation);

/// The pose of one frame against known points: Gauss-Newton on the weighted normal equations (equations 3-5).
/// The weights w_i are Tukey's, with the scale taken from the residuals' median; the first iterations use Huber's,
/// which does not need a good start.
class PoseOptimizer {
 public:
  explicit PoseOptimizer(const PoseOptions& options) : options_(options) {}

  /// `start` is T_cam_world. With fewer than three points the start comes back without inliers.
  PoseEstimate Optimize(std::span<const PoseObservation> observations, const geometry::SE3& start) const;

  /// Whether there are inliers enough to believe the pose.
  bool Accepts(const PoseEstimate& estimate) const { return Accepts(estimate, options_.min_inlier_ratio); }
  bool Accepts(const PoseEstimate& estimate, double min_inlier_ratio) const;

 private:
  PoseOptions options_;
};

}  // namespace evo::odometry
