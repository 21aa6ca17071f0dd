#pragma once

#include "evo/geometry/trajectory.hpp"
#include "evo/simulation/pose_function.hpp"

namespace evo::simulation {

/// A cubic Hermite spline in position and rotation through the poses of a trajectory, with continuous velocity. Time
/// counts from the first pose, which becomes the identity. Error (kInput) for fewer than two poses or poses that are
/// not in order of time; the motion throws Error (kNothingToDo) at times outside the trajectory.
PoseFunction MakeSplineMotion(const geometry::Trajectory& trajectory);

}  // namespace evo::simulation
