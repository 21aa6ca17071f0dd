#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "evo/core/parameters.hpp"
#include "evo/core/time.hpp"
#include "evo/events/tracks.hpp"
#include "evo/geometry/camera.hpp"
#include "evo/geometry/trajectory.hpp"
#include "evo/odometry/final_refinement.hpp"
#include "evo/odometry/frame_handler.hpp"
#include "evo/odometry/ground_scale.hpp"
#include "evo/odometry/point.hpp"
#include "evo/odometry/resampling.hpp"

namespace evo::odometry {

struct OdometryOptions {
  ResamplingOptions resampling;
  FrameHandlerOptions frame_handler;
  FinalRefinementOptions final_refinement;
  GroundOptions ground;
};
void Register(Parameters& parameters, OdometryOptions& options);

struct OdometryResult {
  geometry::Trajectory trajectory;  ///< a pose for every frame that could be estimated, and for no other
  std::vector<int> inliers;         ///< points that agreed with each of them
  /// Of each of them, if there was a final refinement, relative to the first certain pose of its segment and, if the
  /// scale is arbitrary, to the scale that fits the segment best. In units of the trajectory, and rad.
  std::vector<geometry::StampedCovariance> covariances;
  std::vector<Point> points;  ///< the map, world
  bool resampled = false;     ///< the tracks were asynchronous
  int frames = 0;             ///< with and without a pose
  int key_frames = 0;
  std::vector<TimeNs> bootstraps;     ///< first frame of every segment of the map; more than one: the scale was lost
  std::optional<GroundScale> ground;  ///< if the height above it was to be held
  std::vector<TimeNs> lost;           ///< frames between the first and the last pose that have none
};

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
