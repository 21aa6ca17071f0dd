#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/geometry/trajectory.hpp"
#include "evo/odometry/point.hpp"

namespace evo::odometry {

/// The scale by the ground.
struct GroundScale {
  bool found = false;           ///< else the scale is as arbitrary as before
  bool metric = false;          ///< the camera's height was given
  std::size_t tracks = 0;       ///< on the ground
  double covered_ratio = 0.0;   ///< part of the path where the scale is known within a percent
  double relative_sigma = 0.0;  ///< standard deviation of the scale over the scale, median along the path
  double min_scale = 0.0;       ///< m (or new units) to a unit of the map, along the path
  double max_scale = 0.0;       ///< the same
};

struct OdometryResult {
  geometry::Trajectory trajectory;  ///< a pose for every frame that could be estimated, and for no other
  std::vector<int> inliers;         ///< points that agreed with each of them
  /// Of each of them, if there was a final refinement, relative to the first certain pose of its segment and, if the
  /// scale is arbitrary, to the scale that fits the segment best. In units of the trajectory, and rad.
  std::vector<geometry::StampedCovariance> covariances;
  std::vector<Point> points;  ///< the map, world
  bool resampled = false;     ///< the tracks were asynchronous
  int frames = 0;             ///< with and without a pose
  int key_frames = 0;
  std::vector<TimeNs> bootstraps;     ///< first frame of every segment of the map; more than one: the scale was lost
  std::optional<GroundScale> ground;  ///< if the height above it was to be held
  std::vector<TimeNs> lost;           ///< frames between the first and the last pose that have none
};

}  // namespace evo::odometry
