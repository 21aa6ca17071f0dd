#pragma once

#include <filesystem>
#include <vector>

#include "evo/odometry/point.hpp"

namespace evo::odometry {

/// Writes the map as an ASCII PLY point cloud: x, y, z in the world (unit of the trajectory), the track's id, the
/// number of frames that agree with the point. Throws Error (kOutput).
void WriteMap(const std::vector<Point>& points, const std::filesystem::path& path);

}  // namespace evo::odometry
