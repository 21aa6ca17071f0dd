#pragma once

#include <cstdint>
#include <functional>

#include "evo/core/time.hpp"
#include "evo/simulation/scene_options.hpp"
#include "simulation/world/reference_line.hpp"
#include "simulation/world/scene.hpp"

namespace evo::simulation {

/// A street along `road` for a camera `camera_height_m` above it: carriageway, kerbs, pavements, side roads at the
/// junctions, houses, trees, poles and cars, somewhat beyond both ends of the road. Texels measure about 1 cm near the
/// road and 2.5 cm above it. Apart from the road no static surface comes closer than 1 m to the camera's path.
///
/// Oncoming cars reappear at the street's other end. Cars ahead need `camera_distance_m`, the camera's distance along
/// the road: each car is 7 m ahead of where the camera will be 1.3 s later than the car behind it.
Scene MakeStreet(const ReferenceLine& road, const StreetOptions& options, double camera_height_m, std::uint64_t seed,
                 const std::function<double(TimeNs)>& camera_distance_m = {});

/// A room of about 4 m x 3 m x 5 m with boxes and textured walls in the style of UZH's boxes_6dof. The camera starts in
/// its centre and looks along +z.
Scene MakeRoom(std::uint64_t seed);

/// A table with boxes at depths of 0.4 m, 0.7 m and 1 m before a wall with posters at 1.4 m, in the style of UZH's
/// slider_depth, for a camera that moves 1 m to the right.
Scene MakeSliderScene(std::uint64_t seed);

}  // namespace evo::simulation
