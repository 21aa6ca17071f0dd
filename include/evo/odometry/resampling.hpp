#pragma once

#include <vector>

#include "evo/core/parameters.hpp"
#include "evo/events/tracks.hpp"
#include "evo/geometry/camera.hpp"
#include "evo/odometry/frame.hpp"

namespace evo::odometry {

struct ResamplingOptions {
  double frame_interval_s = 0.025;  ///< between the frames made from asynchronous tracks
  double fit_window_s = 0.01;       ///< a straight line is fitted to the sightings this near to the frame
  double max_gap_s = 0.2;           ///< a track is not interpolated across a longer gap
};
void Register(Parameters& parameters, ResamplingOptions& options);

/// Whether the tracks come in frames: most sightings are at stamps that have `least` or more. Fewer than the usual
/// eight are no frame that a pose could be estimated from. `tracks` in order of time.
bool AreSynchronous(const events::Tracks& tracks, int least = 8);

/// Asynchronous tracks at common stamps, `frame_interval_s` apart from the first sighting on. A position is the value
/// of the straight line fitted to the track's sightings near the stamp, or linear interpolation where there are too
/// few; never an extrapolation. `tracks` in order of time; so is the result.
events::Tracks Resample(const events::Tracks& tracks, const ResamplingOptions& options);

/// One frame a stamp, its features undistorted. `tracks` in order of time, then of id.
/// Throws Error (kInput) when more than a few sightings lie off the sensor or outside the lens model: calibration and
/// tracks do not belong together.
std::vector<Frame> BuildFrames(const events::Tracks& tracks, const geometry::Camera& camera);

}  // namespace evo::odometry
