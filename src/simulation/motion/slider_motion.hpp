#pragma once

#include "evo/simulation/pose_function.hpp"
#include "evo/simulation/scene_options.hpp"

namespace evo::simulation {

/// Motion along the camera's x axis at constant speed after a start of 0.1 s. It starts at rest at the identity and
/// goes on after duration_s. Error (kConfiguration) for a duration of at most 0.1 s.
PoseFunction MakeSliderMotion(const SliderOptions& options);

}  // namespace evo::simulation
