#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "evo/geometry/se3.hpp"

namespace evo::odometry {

/// A camera does not jump: what its velocity changes by is white noise (the constant-velocity model). Matters only
/// where tracks are so few that one bad one throws a pose aside.
struct MotionPrior {
  std::vector<double> t;        ///< s, of every pose; empty: no expectation
  double translation_px = 0.0;  ///< what a unit of VelocityChange costs, as an error of a sighting
  double rotation_px = 0.0;     ///< the same of its rotation
};

/// The change of velocity at a pose, over the root of the time that it took: (translation, rotation) of the camera's
/// motion per s^1.5, and its derivatives by the left twists of the three poses, to second order in the angle between
/// them.
struct VelocityChange {
  geometry::Vector6d value;
  geometry::Matrix6d by_before, by_here, by_after;
};

/// At pose `i`, which is neither the first nor the last; `t` in s.
geometry::Vector6d MeasureVelocityChange(const std::vector<geometry::SE3>& poses, const std::vector<double>& t,
                                         std::size_t i);
VelocityChange LinearizeVelocityChange(const std::vector<geometry::SE3>& poses, const std::vector<double>& t,
                                       std::size_t i);

/// With the costs of a prior that expects velocity to change `times` as much as is usual among `poses`, whose sightings
/// have the noise `sigma_px`.
MotionPrior MeasureMotion(const std::vector<geometry::SE3>& poses, std::vector<double> t, double times,
                          double sigma_px);

}  // namespace evo::odometry
