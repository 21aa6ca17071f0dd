#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "odometry/bundle/final_refinement.hpp"
#include "odometry/frontend/frame.hpp"

namespace evo::odometry {

/// A track triangulated with the poses of the frames that see it.
struct TrackPoint {
  std::size_t pose = 0;        ///< the last that sees it, counted over all segments
  Eigen::Vector3d position;    ///< world
  Eigen::Matrix3d covariance;  ///< world, with the track's own residuals as noise
};

/// All tracks that fit the poses, one point for each segment that a track is seen in.
std::vector<TrackPoint> TriangulateTracks(const std::vector<Frame>& frames, const std::vector<Segment>& segments);

}  // namespace evo::odometry
