#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "evo/geometry/se3.hpp"
#include "odometry/frontend/bootstrap.hpp"

namespace evo::odometry {

/// A similarity: p_world = T_world_local * (scale * p_local).
struct Similarity {
  double scale = 1.0;
  geometry::SE3 T_world_local;
};

/// The least-squares similarity (S. Umeyama, PAMI 1991) from new points to the old points of the same tracks, without
/// outliers. Empty if fewer than six tracks are common or the residuals exceed a tenth of the points' spread.
std::optional<Similarity> AlignByPoints(const std::vector<Point>& points,
                                        const std::unordered_map<std::int64_t, Eigen::Vector3d>& old_points);

/// Transforms the poses and points of a new segment to the world.
void Transform(const Similarity& similarity, Bootstrap* bootstrap);

}  // namespace evo::odometry
