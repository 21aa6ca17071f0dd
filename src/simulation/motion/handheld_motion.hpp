#pragma once

#include <cstdint>

#include "evo/simulation/pose_function.hpp"
#include "evo/simulation/scene_options.hpp"

namespace evo::simulation {

/// Band-limited motion in six degrees of freedom. It starts at rest at the identity and goes on after duration_s. No
/// coordinate exceeds four standard deviations. Error (kConfiguration) for a frequency that is not positive.
PoseFunction MakeHandheldMotion(const HandheldOptions& options, std::uint64_t seed);

}  // namespace evo::simulation
