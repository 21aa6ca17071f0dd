#pragma once

#include <vector>

#include "evo/geometry/se3.hpp"
#include "evo/odometry/point.hpp"
#include "odometry/uncertainty/segment_uncertainty.hpp"

namespace evo::odometry {

/// The pose of a tracked frame.
struct SegmentPose {
  int frame = 0;  ///< index among all frames of the run
  geometry::SE3 T_cam_world;
  int inliers = 0;  ///< points that agree with the pose
};

/// A part of the run that was tracked in one map.
struct Segment {
  std::vector<SegmentPose> poses;  ///< in order of time
  std::vector<Point> points;       ///< of the map
  SegmentUncertainty uncertainty;  ///< empty before RefineSegment
};

}  // namespace evo::odometry
