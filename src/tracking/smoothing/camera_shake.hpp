#pragma once

#include <cstddef>
#include <span>

#include "evo/core/time.hpp"
#include "evo/events/tracks.hpp"
#include "evo/geometry/camera.hpp"
#include "tracking/motion/jacobian_table.hpp"
#include "tracking/smoothing/observed_window.hpp"

namespace evo::tracking {

/// Time that is solved by itself, and how much of what was seen before and after it is to be known.
inline constexpr TimeNs kShakeStretch = 5 * kNsPerSecond;
inline constexpr TimeNs kShakeMargin = kNsPerSecond / 2;

/// Gives back to the positions of a stretch what the windows that they come from have smoothed away.
///
/// A position is the intercept of a straight motion fitted to the events of a window, so it is the mean of the true
/// path over that window; the flow is its slope. Where the camera shakes (vibration, bumps) within the long window of a
/// slow feature, that is not where the feature was at the stamp. But the shake is a rotation that all features share,
/// and the fast ones with their short windows show it, and the flows of all. So with a rotation phi(t) that is a cubic
/// B-spline, J_i the image motion that it causes at track i, K_i the mean and L_i the slope over the window, position
/// and flow of each track are
///     x_i(t) = s_i(t) + J_i(t) (K_i phi)(t) + noise,  v_i(t) = s_i'(t) + J_i(t) (L_i phi)(t) + noise
/// with a smooth path s_i, of which fourth differences of positions and second differences of flows leave next to
/// nothing. phi follows from those of all tracks by robust linear least squares, and each position moves by
/// J_i (phi - K_i phi). The sensor smears positions besides, since dark pixels answer late: K_i is of a longer window.
///
/// Frames must be evenly spaced; where they are more than 25 ms apart they cannot show a shake and nothing changes.
/// `seen`: all observations of the stretch and its margins, in order of time; `windows`: of each of them. `restored`:
/// those of the stretch, a copy of `seen` from index `first` on.
void RestoreShake(const geometry::Camera& camera, const JacobianTable& lens, std::span<const events::TrackObservation> seen,
                  std::span<const ObservedWindow> windows, std::size_t first,
                  std::span<events::TrackObservation> restored);

}  // namespace evo::tracking
