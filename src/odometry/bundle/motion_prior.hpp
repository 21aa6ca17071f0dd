#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "evo/geometry/se3.hpp"

namespace evo::odometry {

/// The white-noise-on-acceleration prior: the change of the camera's velocity between frames is white noise
/// (T. D. Barfoot: State Estimation for Robotics, 2017, chapter 10). It matters only where tracks are so few that a bad
/// one displaces a pose.
struct MotionPrior {
  std::vector<double> times_s;         ///< of every pose; empty: no prior
  double translation_weight_px = 0.0;  ///< error in px that a unit of VelocityChange's translation counts as
  double rotation_weight_px = 0.0;     ///< the same for its rotation
};

/// The change of velocity at a pose divided by the square root of the time between the two velocities: (translation,
/// rotation) of the camera's motion per s^1.5; and its Jacobians by the left twists of the three poses T_cam_world, to
/// second order in the angle between them.
struct VelocityChange {
  geometry::Vector6d value;
  geometry::Matrix6d J_previous, J_current, J_next;
};

/// At pose `i`, which is neither the first nor the last; times in s.
geometry::Vector6d ComputeVelocityChange(const std::vector<geometry::SE3>& T_cam_world,
                                         const std::vector<double>& times_s, std::size_t i);
VelocityChange LinearizeVelocityChange(const std::vector<geometry::SE3>& T_cam_world,
                                       const std::vector<double>& times_s, std::size_t i);

/// The prior whose standard deviations are `velocity_change_scale` times the robust ones of the changes among these
/// poses; weighted against observations of standard deviation `sigma_px`. No prior if a median change is zero.
MotionPrior EstimateMotionPrior(const std::vector<geometry::SE3>& T_cam_world, std::vector<double> times_s,
                                double velocity_change_scale, double sigma_px);

}  // namespace evo::odometry
