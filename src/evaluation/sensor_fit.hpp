#pragma once

#include <vector>

#include "evo/evaluation/track_truth.hpp"

namespace evo {

/// Throws Error (kInput) when more than a fifth of the positions lie off the sensor or outside the lens model.
void CheckSensorFit(const std::vector<FeatureTrack>& tracks, const Camera& camera);

}  // namespace evo
