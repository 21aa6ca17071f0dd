#pragma once

#include <vector>

#include "evo/events/tracks.hpp"
#include "evo/geometry/camera.hpp"
#include "odometry/frontend/frame.hpp"

namespace evo::odometry {

/// One frame a stamp, its features undistorted. `tracks` in order of time, then of id.
/// Throws Error (kInput) when more than a few sightings lie off the sensor or outside the lens model: calibration and
/// tracks do not belong together.
std::vector<Frame> BuildFrames(const events::Tracks& tracks, const geometry::Camera& camera);

}  // namespace evo::odometry
