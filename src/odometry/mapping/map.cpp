#include "odometry/mapping/map.hpp"

#include <algorithm>

namespace evo::odometry {

const Point* Map::Find(std::int64_t track) const {
  const auto found = points.find(track);
  return found == points.end() ? nullptr : &found->second;
}

SceneDepth MeasureSceneDepth(std::vector<double> depths) {
  if (depths.empty()) return {};
  std::ranges::sort(depths);
  return {depths[depths.size() / 2], depths[depths.size() / 20]};
}

}  // namespace evo::odometry
