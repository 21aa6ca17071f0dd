#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>

#include "evo/core/time.hpp"
#include "evo/simulation/pose_function.hpp"
#include "evo/simulation/scene_options.hpp"
#include "simulation/world/reference_line.hpp"

namespace evo::simulation {

/// The camera's pose and the distance travelled along the road (m).
struct VehicleMotion {
  PoseFunction T_world_cam;
  std::function<double(TimeNs)> distance_m;
};

/// The rotation of the camera's mount.
Eigen::Quaterniond MountRotation(const VehicleOptions& options);

/// Drives a camera along a road. The camera follows the road's heading and slope; bumps act on it only while it moves.
/// At time 0 its pose is the identity but for the angles of its mount: a point of the road lies in the world at
/// ReferenceLine::Point::position plus camera_height_m in y. The vehicle stops at the road's end. It keeps its velocity
/// before 0 and after duration_s. Error (kConfiguration) for an option out of range.
VehicleMotion MakeVehicleMotion(const ReferenceLine& road, const VehicleOptions& options, std::uint64_t seed);

}  // namespace evo::simulation
