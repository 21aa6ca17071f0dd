#pragma once

#include "evo/events/tracks.hpp"
#include "evo/odometry/odometry_options.hpp"

namespace evo::odometry {

/// Whether the tracks come in frames: most observations share their stamp with at least `min_features` of them. A pose
/// cannot be estimated reliably from fewer than the default. `tracks` in order of time.
bool AreSynchronous(const events::Tracks& tracks, int min_features = 8);

/// Resamples asynchronous tracks at common stamps, `frame_interval_s` apart from the first observation on. A position
/// is the value of a line fitted to the track's observations within `fit_window_s` of the stamp, or the linear
/// interpolation if there are too few; nothing is extrapolated. `tracks` and result in order of time.
events::Tracks Resample(const events::Tracks& tracks, const ResamplingOptions& options);

}  // namespace evo::odometry
