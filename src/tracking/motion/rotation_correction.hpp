#pragma once

#include <Eigen/Core>
#include <span>

namespace evo::tracking {

/// Aligned minus predicted motion of a feature.
struct PredictionResidual {
  Eigen::Matrix<double, 2, 3> J_pixel_rotation;  ///< see PixelJacobians
  Eigen::Vector2d offset;                        ///< px
  Eigen::Vector2d flow;                          ///< px/s
};

/// Rotation of the camera beyond the predicted one, as when a wheel hits a bump. Both vectors are of the world about
/// the camera, in the camera frame.
struct RotationCorrection {
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();          ///< since the last frame, rad
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< rad/s
  double rms_motion_px = 0.0;  ///< root mean square of the features' motion that `rotation` causes
};

/// Estimates the rotation and the angular velocity that all residuals share, by robust linear least squares. Zero if
/// there are too few residuals.
RotationCorrection EstimateRotationCorrection(std::span<const PredictionResidual> residuals);

}  // namespace evo::tracking
