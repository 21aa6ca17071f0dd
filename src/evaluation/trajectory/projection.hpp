#pragma once

#include <string>

#include "evo/geometry/se3.hpp"

namespace evo::evaluation {

/// Lays a pose into a plane of its world: "xy", "xz" or "yz"; "none" leaves it as it is. The coordinate across the
/// plane becomes 0. Of the rotation, written Rz(c) Ry(b) Rx(a), only the factor about the plane's normal is kept, as
/// evo does.
geometry::SE3 Project(const geometry::SE3& T_world_cam, const std::string& plane);

}  // namespace evo::evaluation
