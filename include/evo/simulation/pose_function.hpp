#pragma once

#include <functional>

#include "evo/core/time.hpp"
#include "evo/geometry/se3.hpp"

namespace evo::simulation {

/// The pose T_world_cam (or T_world_body) at a time since the start of the run. It is smooth, depends on its argument
/// alone and may be called from several threads at once.
using PoseFunction = std::function<geometry::SE3(TimeNs)>;

}  // namespace evo::simulation
