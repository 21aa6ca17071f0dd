#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "evo/odometry/frame.hpp"
#include "evo/odometry/point.hpp"

namespace evo {

/// The points of the map by their track's id, and the key frames in order of time.
struct Map {
  std::map<std::int64_t, Point> points;
  std::vector<Frame> key_frames;

  const Point* Find(std::int64_t track) const;
};

}  // namespace evo
