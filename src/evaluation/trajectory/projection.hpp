#pragma once

#include <string>

#include "evo/geometry/se3.hpp"

namespace evo::evaluation {

/// Projects a pose onto a plane of its world frame, as evo does: "xy", "xz" or "yz"; "none" returns the pose. The
/// coordinate along the normal becomes 0, and of the rotation Rz(c) Ry(b) Rx(a) only the factor about the normal stays.
geometry::SE3 Project(const geometry::SE3& T_world_cam, const std::string& plane);

}  // namespace evo::evaluation
