#include "evo/odometry/map.hpp"

namespace evo {

const Point* Map::Find(std::int64_t track) const {
  const auto found = points.find(track);
  return found == points.end() ? nullptr : &found->second;
}

}  // namespace evo
