#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace evo::odometry {

/// One observation of a track in a frame.
struct Feature {
  std::int64_t track = 0;
  Eigen::Vector2d x = Eigen::Vector2d::Zero();  ///< undistorted, on the plane z = 1
  /// Raw pixels a unit on the plane z = 1 at x: the lens's Jacobian, which turns residuals there into pixels of the
  /// sensor, where the noise lives.
  Eigen::Matrix2d J_pixel_normalized = Eigen::Matrix2d::Identity();
};

}  // namespace evo::odometry
