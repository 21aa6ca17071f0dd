#pragma once

#include <Eigen/Core>
#include <span>

namespace evo::tracking {

/// What a feature did beyond its prediction.
struct UnexpectedMotion {
  Eigen::Matrix<double, 2, 3> by_rotation;  ///< px for a turn of the world, rad
  Eigen::Vector2d offset;                   ///< px
  Eigen::Vector2d flow;                     ///< px/s
};

/// A turn of the camera that no feature's past foretold, as when a wheel hits a bump: of the world about the camera.
struct Jolt {
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();       ///< since the last frame, rad
  Eigen::Vector3d turn_rate = Eigen::Vector3d::Zero();  ///< rad/s
  double motion_px = 0.0;                               ///< root mean square of the features' motion by `turn`
};

/// The turn and the turn rate that the unexpected motions have in common, by robust linear least squares. None where
/// there are too few of them.
Jolt FindJolt(std::span<const UnexpectedMotion> motions);

}  // namespace evo::tracking
