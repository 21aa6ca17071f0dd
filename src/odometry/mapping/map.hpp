#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "evo/odometry/point.hpp"
#include "odometry/frontend/frame.hpp"

namespace evo::odometry {

/// The points by the id of their track, and the key frames in order of time.
struct Map {
  std::map<std::int64_t, Point> points;
  std::vector<Frame> key_frames;

  /// The point of a track; null if there is none.
  const Point* Find(std::int64_t track) const;
};

/// Depths of map points in a camera.
struct SceneDepth {
  double median = 0.0;
  double near = 0.0;  ///< 5th percentile
};
/// `depths` are positive; zeros for none.
SceneDepth MeasureSceneDepth(std::vector<double> depths);

}  // namespace evo::odometry
