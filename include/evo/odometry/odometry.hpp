#pragma once

#include <functional>

#include "evo/events/tracks.hpp"
#include "evo/geometry/camera.hpp"
#include "evo/odometry/odometry_options.hpp"
#include "evo/odometry/odometry_result.hpp"

namespace evo::odometry {

/// The stages of the odometry: frame by frame, then the refinement of the whole run.
enum class OdometryStage { kFrames, kRefinement };

/// Called with the ratio of a stage that is done, in [0, 1].
using OdometryProgress = std::function<void(OdometryStage stage, double ratio)>;

/// Monocular visual odometry from feature tracks: the pose and depth threads of D. Zhu et al. (Neuromorphic Visual
/// Odometry System for Intelligent Vehicle Application with Bio-inspired Vision Sensor, ROBIO 2019; "equation" in this
/// module refers to that paper), then a refinement of the whole run. The scale is arbitrary unless the height of the
/// camera above the road is given. The result does not depend on `threads`; with more than one the depths have a thread
/// of their own. Throws Error: kInput if tracks and camera do not belong together, kTrackingLost if no map can be
/// started.
OdometryResult RunOdometry(const events::Tracks& tracks, const geometry::Camera& camera, const OdometryOptions& options,
                           int threads, const OdometryProgress& progress);

}  // namespace evo::odometry
