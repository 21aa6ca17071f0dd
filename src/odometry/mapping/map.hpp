#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "evo/odometry/point.hpp"
#include "odometry/frontend/frame.hpp"

namespace evo::odometry {

/// The points of the map by their track's id, and the key frames in order of time.
struct Map {
  std::map<std::int64_t, Point> points;
  std::vector<Frame> key_frames;

  const Point* Find(std::int64_t track) const;
};

/// Depths in a camera of the map's points that a frame sees.
struct SceneDepth {
  double median = 0.0;
  double near = 0.0;  ///< the 5 % nearest are nearer
};
/// `depths` are positive; zeros if it is empty.
SceneDepth MeasureSceneDepth(std::vector<double> depths);

}  // namespace evo::odometry
