#pragma once

#include <filesystem>
#include <vector>

#include "evo/odometry/point.hpp"

namespace evo::odometry {

/// The map as an ASCII PLY point cloud: x y z in the world (in the unit of the trajectory), the track's id, and how
/// many frames agreed with the point. Throws Error (kOutput).
void WriteMap(const std::vector<Point>& points, const std::filesystem::path& path);

}  // namespace evo::odometry
