#include "tracking/event_window.hpp"

#include <algorithm>
#include <cmath>

namespace evo::tracking {

namespace {

constexpr double kMinFlowPxS = 1e-3;          // guards a division
constexpr double kMinAccelerationPxS2 = 1.0;  // guards a division

}  // namespace

TimeNs HalfWindow(const Eigen::Vector2d& flow, double motion_px, const TrackerOptions& options) {
  const double window_s = motion_px / std::max(flow.norm(), kMinFlowPxS);
  return FromSeconds(0.5 * std::min(std::max(window_s, options.min_window_s), options.max_window_s));
}

TimeNs DoubledHalfWindow(TimeNs half_window, const TrackerOptions& options) {
  return std::min(2 * half_window, FromSeconds(0.5 * options.max_window_s));
}

TimeNs FeatureHalfWindow(const Eigen::Vector2d& flow, const EgoMotion& ego_motion, const TrackerOptions& options) {
  const TimeNs by_motion = HalfWindow(flow, options.window_motion_px, options);
  const double acceleration_px_s2 = ego_motion.jacobians().focal_px() * ego_motion.typical_angular_acceleration();
  const double straight_s =
      std::sqrt(2.0 * options.window_curvature_px / std::max(acceleration_px_s2, kMinAccelerationPxS2));
  return std::min(by_motion, FromSeconds(std::max(straight_s, 0.5 * options.min_window_s)));
}

}  // namespace evo::tracking
