#pragma once

#include <cstddef>
#include <span>

#include "evo/core/time.hpp"
#include "evo/events/tracks.hpp"
#include "evo/geometry/camera.hpp"
#include "tracking/motion/jacobian_table.hpp"
#include "tracking/smoothing/observed_window.hpp"

namespace evo::tracking {

/// Duration that one spline covers, and the margin before and after it whose observations the spline depends on.
inline constexpr TimeNs kSplineSegment = 5 * kNsPerSecond;
inline constexpr TimeNs kSplineMargin = kNsPerSecond / 2;

/// Restores the fast rotation of the camera (vibration, bumps) that the windows of the positions average away.
///
/// A position is the intercept, and a flow the slope, of a straight motion fitted to the events of a window, so they
/// are the mean and the mean slope of the true path over this window. Fast features have short windows and observe the
/// fast rotation, which all features share. With a rotation phi(t) that is a cubic B-spline, J_i the Jacobian of image
/// point i by a rotation, and K_i and L_i the mean and the mean slope over the window, position and flow of track i are
///     x_i(t) = s_i(t) + J_i(t) (K_i phi)(t) + noise,  v_i(t) = s_i'(t) + J_i(t) (L_i phi)(t) + noise,
/// with a smooth path s_i that fourth differences of positions and second differences of flows remove. The coefficients
/// of phi follow from the differences of all tracks by robust linear least squares. Each position then moves by
/// J_i (phi - K_i phi). The sensor itself averages too, since dark pixels respond late: K_i covers a longer window.
///
/// Frames must be evenly spaced. Positions do not change if frames are more than 25 ms apart.
/// `observed`: all observations of the segment and its margins, ordered by time; `windows`: of each of them.
/// `restored`: those of the segment, a copy of `observed` from index `first` on.
void RestoreRotation(const geometry::Camera& camera, const JacobianTable& jacobians,
                     std::span<const events::TrackObservation> observed, std::span<const ObservedWindow> windows,
                     std::size_t first, std::span<events::TrackObservation> restored);

}  // namespace evo::tracking
