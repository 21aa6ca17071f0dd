#pragma once

#include <vector>

#include "evo/evaluation/track_truth.hpp"

namespace evo::evaluation {

/// Throws Error (kInput) when more than a fifth of the positions lie off the sensor or outside the lens model.
void CheckSensorFit(const std::vector<FeatureTrack>& tracks, const geometry::Camera& camera);

}  // namespace evo::evaluation
