#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace evo::odometry {

/// A point of the map: what one track has converged to, and how well its frames agreed with it.
struct Point {
  std::int64_t track = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< world
  int inliers = 0;                                     ///< frames that agreed with the point
  int outliers = 0;                                    ///< frames that contradicted it
};

}  // namespace evo::odometry
