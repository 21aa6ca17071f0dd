#pragma once

#include <vector>

#include "evo/geometry/trajectory.hpp"

namespace evo::evaluation {

inline constexpr TimeNs kStep = 50'000'000;

/// The MVSEC world: x right, y down, z forward; the camera looks along z.
inline geometry::Trajectory TrajectoryAlong(const std::vector<Eigen::Vector3d>& positions) {
  geometry::Trajectory trajectory;
  for (const auto& p : positions) {
    trajectory.push_back({static_cast<TimeNs>(trajectory.size()) * kStep, geometry::SE3({1, 0, 0, 0}, p)});
  }
  return trajectory;
}

inline geometry::Trajectory StraightAhead(int poses, double step) {
  std::vector<Eigen::Vector3d> positions;
  for (int i = 0; i < poses; ++i) positions.push_back({0, 0, step * i});
  return TrajectoryAlong(positions);
}

}  // namespace evo::evaluation
