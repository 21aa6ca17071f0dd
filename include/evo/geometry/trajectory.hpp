#pragma once

#include <vector>

#include "evo/core/time.hpp"
#include "evo/geometry/se3.hpp"

namespace evo {

struct StampedPose {
  TimeNs t = 0;
  SE3 T_world_cam;
};

/// Poses in strictly increasing order of time.
using Trajectory = std::vector<StampedPose>;

}  // namespace evo
