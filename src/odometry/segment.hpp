#pragma once

#include <cstddef>
#include <vector>

#include "evo/geometry/se3.hpp"
#include "evo/odometry/point.hpp"
#include "odometry/uncertainty/pose_uncertainty.hpp"

namespace evo::odometry {

/// A stretch of frames that were tracked in one map, and what is known of them.
struct Segment {
  std::vector<int> frames;                 ///< indices, in order of time
  std::vector<geometry::SE3> T_cam_world;  ///< of these frames
  std::vector<int> inliers;                ///< of these frames
  std::vector<Point> points;               ///< of the map

  // How far the poses may be off; empty before RefineSegment.
  PoseUncertainty uncertainty;        ///< of those that were adjusted together
  std::vector<std::size_t> adjusted;  ///< which of these frames those are
  /// Of every pose, besides the uncertainty of the last adjusted one before it, or of the first: of left twists.
  std::vector<geometry::Matrix6d> besides;

  /// Of the left twists of these poses, relative to the first adjusted one, see PoseUncertainty.
  std::vector<geometry::Matrix6d> Covariances(bool scale_is_free) const;
};

}  // namespace evo::odometry
