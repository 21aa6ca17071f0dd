#pragma once

#include <Eigen/Core>

#include "evo/core/time.hpp"
#include "evo/tracking/tracker_options.hpp"
#include "tracking/motion/ego_motion.hpp"

namespace evo::tracking {

/// Half of the window in which `flow` (px/s) moves a point by `motion_px`, within the limits of the options: the
/// integration time of A. Z. Zhu et al., per feature.
TimeNs HalfWindow(const Eigen::Vector2d& flow, double motion_px, const TrackerOptions& options);

/// Half of a feature's window. It is also so short that the typical angular acceleration of the camera displaces the
/// feature from a straight path by `window_curvature_px` at most.
TimeNs FeatureHalfWindow(const Eigen::Vector2d& flow, const EgoMotion& ego_motion, const TrackerOptions& options);

/// Half of a window of twice the length, for a patch whose window has too few events; limited by the options.
TimeNs DoubledHalfWindow(TimeNs half_window, const TrackerOptions& options);

}  // namespace evo::tracking
