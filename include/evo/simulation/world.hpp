#pragma once

#include <cstdint>
#include <string>

#include "evo/core/parameters.hpp"
#include "evo/simulation/motion.hpp"
#include "evo/simulation/scene.hpp"

namespace evo {

struct StreetOptions {
  double road_width_m = 7.0;
  double pavement_width_m = 2.0;
  double house_share = 0.85;  ///< of the way lined with facades; the rest is open
  double trees_per_100_m = 6.0;
  double poles_per_100_m = 4.0;
  double parked_cars_per_100_m = 6.0;
  double moving_cars_per_100_m = 0.5;  ///< oncoming and ahead, both ways
  double moving_car_speed_m_s = 9.0;
  std::string light = "day";  ///< or "night": lamps along the road, head lamps, lit windows
};
void Register(Parameters& parameters, StreetOptions& options);

/// A street along `road` for a camera `camera_height_m` above it, from the seed. Surfaces are long where they can be
/// (few are seen at once) and textures fine near the road (about 1 cm) and coarser above.
Scene MakeStreet(const RoadLine& road, const StreetOptions& options, double camera_height_m, std::uint64_t seed);

/// A room with textured walls, floor and boxes in it, about 4 m x 3 m x 5 m, in the style of the UZH boxes_6dof; the
/// camera starts in its middle looking along +z.
Scene MakeRoom(std::uint64_t seed);

/// Posters at three depths (0.8 m to 2.5 m) before a camera on a slider, in the style of slider_depth.
Scene MakeSliderScene(std::uint64_t seed);

}  // namespace evo
