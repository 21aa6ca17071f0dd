#pragma once

#include <cstdint>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/geometry/se3.hpp"
#include "odometry/frontend/feature.hpp"

namespace evo::odometry {

/// All features seen at one instant and the pose of the camera then.
struct Frame {
  TimeNs t = 0;
  geometry::SE3 T_cam_world;      ///< meaningful once the frame has been tracked
  std::vector<Feature> features;  ///< in order of their tracks' ids

  /// Null if the track is not seen in this frame.
  const Feature* Find(std::int64_t track) const;
};

/// A track seen in two frames.
struct FeaturePair {
  const Feature* first;
  const Feature* second;
};

/// The tracks that two frames share; the pointers live as long as the frames.
std::vector<FeaturePair> Match(const Frame& first, const Frame& second);

/// Median image motion of the shared tracks in raw pixels (first order); 0 if there are none.
double MedianDisparity(const std::vector<FeaturePair>& pairs);

}  // namespace evo::odometry
