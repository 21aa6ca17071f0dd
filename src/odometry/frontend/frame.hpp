#pragma once

#include <cstdint>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/geometry/se3.hpp"
#include "odometry/frontend/feature.hpp"

namespace evo::odometry {

/// The features of one instant and the pose of the camera.
struct Frame {
  TimeNs t = 0;
  geometry::SE3 T_cam_world;      ///< valid once the frame has been tracked
  std::vector<Feature> features;  ///< in order of their tracks' ids

  /// The feature of a track; null if the frame does not observe it.
  const Feature* Find(std::int64_t track) const;
};

/// A track's features in two frames.
struct FeaturePair {
  const Feature* first;
  const Feature* second;
};

/// Pairs the features of the tracks that both frames observe. The pointers live as long as the frames.
std::vector<FeaturePair> Match(const Frame& first, const Frame& second);

/// The median image motion of the pairs in raw pixels (to first order); 0 for no pairs.
double MedianDisparity(const std::vector<FeaturePair>& pairs);

}  // namespace evo::odometry
