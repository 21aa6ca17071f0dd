#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "evo/core/parameters.hpp"
#include "evo/simulation/motion.hpp"
#include "evo/simulation/scene.hpp"

namespace evo::simulation {

struct StreetOptions {
  double road_width_m = 7.0;     ///< both lanes; the camera drives in the middle of the right one
  double parking_width_m = 2.2;  ///< strip for parked cars on each side
  double pavement_width_m = 2.0;
  double house_share = 0.85;           ///< of the way lined with facades; the rest is open
  double trees_per_100_m = 6.0;        ///< both sides together, as of all that follows; none at crossings
  double poles_per_100_m = 4.0;        ///< street lamps, some with traffic signs
  double parked_cars_per_100_m = 6.0;  ///< none if the parking strip is too narrow for a car
  double oncoming_cars_per_100_m = 0.5;
  double oncoming_car_speed_m_s = 9.0;
  int cars_ahead = 0;              ///< in the camera's lane, driving as it does
  std::string light = "day";       ///< or "night": lamps along the road, head lamps, lit windows
  double night_ambient = 0.02;     ///< Lighting::ambient at night
  double head_lamps = 12.0;        ///< Lighting::head_lamps at night
  double lamp_flicker_hz = 120.0;  ///< Lighting::flicker_hz at night
};
/// Names street.*.
void Register(Parameters& parameters, StreetOptions& options);

/// A street along `road` for a camera `camera_height_m` above it, from the seed: carriageway, kerbs, pavements, side
/// roads at the crossings, houses, trees, poles, cars, all of planar pieces; a little of it behind the start and past
/// the end. Textures of about 1 cm near the road and 2.5 cm above. Nothing static but the road comes nearer than 1 m to
/// the camera's path. Oncoming cars come back at the street's other end. Cars ahead need `camera_distance_m`, the
/// camera's place on the road over time: each is where the camera will be 1.3 s later than the car behind it, and 7 m
/// further.
Scene MakeStreet(const RoadLine& road, const StreetOptions& options, double camera_height_m, std::uint64_t seed,
                 const std::function<double(TimeNs)>& camera_distance_m = {});

/// A room with textured walls, floor and boxes in it, about 4 m x 3 m x 5 m, in the style of the UZH boxes_6dof; the
/// camera starts in its middle looking along +z.
Scene MakeRoom(std::uint64_t seed);

/// A table with boxes at 0.4 m, 0.7 m and 1 m before a wall with posters at 1.4 m, for a camera on a slider that goes
/// 1 m to the right, in the style of slider_depth.
Scene MakeSliderScene(std::uint64_t seed);

}  // namespace evo::simulation
