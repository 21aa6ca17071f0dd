#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "odometry/frontend/frame.hpp"
#include "odometry/segment.hpp"

namespace evo::odometry {

/// A track triangulated from the poses of the frames that observe it.
struct TriangulatedTrack {
  std::size_t last_pose = 0;   ///< that observes it, counted over all segments
  Eigen::Vector3d position;    ///< world
  Eigen::Matrix3d covariance;  ///< world, with the track's own residuals as noise
};

/// All tracks that agree with the poses; a track in several segments gives a point in each.
std::vector<TriangulatedTrack> TriangulateTracks(const std::vector<Frame>& frames,
                                                 const std::vector<Segment>& segments);

}  // namespace evo::odometry
