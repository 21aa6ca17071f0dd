#pragma once

#include <vector>

#include "evo/events/tracks.hpp"
#include "evo/geometry/camera.hpp"
#include "odometry/frontend/frame.hpp"

namespace evo::odometry {

/// Groups observations of the same stamp into frames and undistorts them. `tracks` in order of time, then of id.
/// Throws Error (kInput) if more than 2 % of the observations lie off the sensor or outside the lens model.
std::vector<Frame> BuildFrames(const events::Tracks& tracks, const geometry::Camera& camera);

}  // namespace evo::odometry
