#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "evo/geometry/se3.hpp"
#include "odometry/frontend/bootstrap.hpp"

namespace evo::odometry {

/// p_world = T_world_local * (scale * p_local).
struct Similarity {
  double scale = 1.0;
  geometry::SE3 T_world_local;
};

/// The similarity that takes new points to the old points of the same tracks, in the least-squares sense with the worst
/// left out. Empty with fewer than six common points or if they do not agree within a tenth of their spread.
std::optional<Similarity> AlignByPoints(const std::vector<Point>& points,
                                        const std::unordered_map<std::int64_t, Eigen::Vector3d>& old_points);

/// Takes a new segment's poses and points to the world.
void Transform(const Similarity& similarity, Bootstrap* bootstrap);

}  // namespace evo::odometry
