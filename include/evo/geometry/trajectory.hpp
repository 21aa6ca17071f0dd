#pragma once

#include <optional>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/geometry/se3.hpp"

namespace evo::geometry {

struct StampedPose {
  TimeNs t = 0;
  SE3 T_world_cam;
};

/// Poses in strictly increasing order of time.
using Trajectory = std::vector<StampedPose>;

/// The covariance of a pose's error (x, y, z, rx, ry, rz): position and rotation vector along the axes of the world,
/// in the trajectory's unit of length and rad.
struct StampedCovariance {
  TimeNs t = 0;
  Matrix6d covariance;
};

/// The pose at `t`, interpolated between its neighbours. Empty outside the trajectory and where the neighbours are more
/// than `max_interval` apart.
std::optional<SE3> PoseAt(const Trajectory& trajectory, TimeNs t, TimeNs max_interval);

/// The sum of the distances between consecutive positions; 0 for less than two poses.
double PathLength(const Trajectory& trajectory);

}  // namespace evo::geometry
