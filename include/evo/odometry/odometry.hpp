#pragma once

#include <functional>

#include "evo/events/tracks.hpp"
#include "evo/geometry/camera.hpp"
#include "evo/odometry/odometry_options.hpp"
#include "evo/odometry/odometry_result.hpp"

namespace evo::odometry {

/// The parts of the work: frame by frame, then the refinement over the whole run.
enum class OdometryStage { kFrames, kRefinement };

/// Called with the share of a part that is done, in [0, 1].
using OdometryProgress = std::function<void(OdometryStage stage, double done)>;

/// Monocular visual odometry from feature tracks: the paper's pose and depth threads, then one refinement over the
/// whole run. The scale is arbitrary unless the camera's height above the road is given. The result does not depend on
/// `threads` (2 or more: the depths get their own thread). Throws Error: kInput if tracks and camera do not belong
/// together, kTrackingLost if no map could ever be started.
OdometryResult RunOdometry(const events::Tracks& tracks, const geometry::Camera& camera, const OdometryOptions& options,
                           int threads, const OdometryProgress& progress);

}  // namespace evo::odometry
