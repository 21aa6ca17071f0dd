#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace evo::odometry {

/// One observation of a track in a frame.
struct Feature {
  std::int64_t track = 0;                       ///< id
  Eigen::Vector2d x = Eigen::Vector2d::Zero();  ///< undistorted, on the normalized plane z = 1
  /// Jacobian of the raw pixel by x. It turns residuals on the plane z = 1 into pixels of the sensor, where the noise
  /// is the same everywhere.
  Eigen::Matrix2d J_pixel_normalized = Eigen::Matrix2d::Identity();
};

}  // namespace evo::odometry
