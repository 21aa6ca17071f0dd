#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/geometry/trajectory.hpp"
#include "evo/odometry/point.hpp"

namespace evo::odometry {

/// The scale from the height above the ground.
struct GroundScale {
  bool found = false;           ///< otherwise the scale is arbitrary and may drift
  bool metric = false;          ///< the height of the camera was given
  std::size_t tracks = 0;       ///< number of tracks on the ground
  double covered_ratio = 0.0;   ///< part of the path where the scale is known within a percent
  double relative_sigma = 0.0;  ///< standard deviation of the scale over the scale, median along the path
  double min_scale = 0.0;       ///< along the path, m (or new units) per unit of the map
  double max_scale = 0.0;       ///< the same
};

/// What a frame offered when the pose was lost there.
struct TrackingLoss {
  TimeNs t = 0;
  std::size_t features = 0;    ///< tracks in the frame
  std::size_t map_points = 0;  ///< of these with a point of the map
  std::size_t inliers = 0;     ///< of these that agree with the best pose
};

struct OdometryResult {
  geometry::Trajectory trajectory;  ///< the poses of the frames that could be tracked
  std::vector<int> inliers;         ///< number of points that agree with each pose
  /// The covariance of each pose, in units of the trajectory and rad; empty without final refinement. It is relative to
  /// the first certain pose of its segment and, if the scale is arbitrary, to the scale that fits the segment best.
  std::vector<geometry::StampedCovariance> covariances;
  std::vector<Point> points;          ///< the map
  bool resampled = false;             ///< the tracks were asynchronous
  int frames = 0;                     ///< number of frames, with and without a pose
  int key_frames = 0;                 ///< number of key frames
  std::vector<TimeNs> bootstraps;     ///< first frame of every segment; with more than one the scale was lost between
  std::vector<TrackingLoss> losses;   ///< where the pose was lost, with and without a new segment after it
  std::optional<GroundScale> ground;  ///< if the height above the ground is held
  std::vector<TimeNs> lost;           ///< frames without a pose between the first and the last pose
};

}  // namespace evo::odometry
