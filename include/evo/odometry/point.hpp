#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace evo::odometry {

/// A point of the map with the track that it belongs to.
struct Point {
  std::int64_t track = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< world
  int inliers = 0;                                     ///< number of frames that agree with the point
  int outliers = 0;                                    ///< number of frames that contradict the point
};

}  // namespace evo::odometry
