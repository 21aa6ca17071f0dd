#pragma once

#include "evo/events/tracks.hpp"
#include "evo/odometry/odometry_options.hpp"

namespace evo::odometry {

/// Whether the tracks come in frames: most sightings are at stamps that have `least` or more. Fewer than the usual
/// eight are no frame that a pose could be estimated from. `tracks` in order of time.
bool AreSynchronous(const events::Tracks& tracks, int least = 8);

/// Asynchronous tracks at common stamps, `frame_interval_s` apart from the first sighting on. A position is the value
/// of the straight line fitted to the track's sightings near the stamp, or linear interpolation where there are too
/// few; never an extrapolation. `tracks` in order of time; so is the result.
events::Tracks Resample(const events::Tracks& tracks, const ResamplingOptions& options);

}  // namespace evo::odometry
