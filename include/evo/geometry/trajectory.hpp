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

/// How far a pose may be off: covariance of (x, y, z, rx, ry, rz), its position and its rotation vector, both along the
/// axes of the world.
struct StampedCovariance {
  TimeNs t = 0;
  Matrix6d covariance;
};

/// The pose at `t`, interpolated between its neighbours. Empty outside the trajectory, which is never extrapolated, and
/// where the neighbours are more than `max_interval` apart.
std::optional<SE3> PoseAt(const Trajectory& trajectory, TimeNs t, TimeNs max_interval);

/// From position to position, m; 0 for one pose or none.
double PathLength(const Trajectory& trajectory);

}  // namespace evo::geometry
