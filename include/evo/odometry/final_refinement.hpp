#pragma once

#include <functional>
#include <vector>

#include "evo/core/parallel.hpp"
#include "evo/core/parameters.hpp"
#include "evo/odometry/frame.hpp"
#include "evo/odometry/point.hpp"
#include "evo/odometry/pose_uncertainty.hpp"

namespace evo::odometry {

struct FinalRefinementOptions {
  bool enabled = true;
  double min_disparity_px = 1.5;  ///< frames with less image motion since the last one taken are left to the end
  /// Variance of what tracks drift by from one of these frames to the next, over that of their noise, see
  /// InnovationStep.
  double drift = 0.04;
  /// Velocity is expected to change so many times as much as is usual, see MotionPrior; 0: no matter how much.
  double motion = 2.0;
  bool own_noise = true;  ///< a track counts as much as its own noise lets it, see WeighTracks
  int rounds = 3;         ///< of adjustment, the noise measured anew before each
  int iterations = 4;     ///< of each round
  double budget = 4e6;    ///< 6x6 block products an iteration may cost; beyond it frames are thinned out
  CommonErrors common_errors;
};
void Register(Parameters& parameters, FinalRefinementOptions& options);

/// A stretch of frames that were tracked in one map, and what is known of them.
struct Segment {
  std::vector<int> frames;                 ///< indices, in order of time
  std::vector<geometry::SE3> T_cam_world;  ///< of these frames
  std::vector<int> inliers;                ///< of these frames
  std::vector<Point> points;               ///< of the map

  // How far the poses may be off; empty before RefineSegment.
  PoseUncertainty uncertainty;        ///< of those that were adjusted together
  std::vector<std::size_t> adjusted;  ///< which of these frames those are
  /// Of every pose, besides the uncertainty of the last adjusted one before it, or of the first: of left twists.
  std::vector<geometry::Matrix6d> besides;

  /// Of the left twists of these poses, relative to the first adjusted one, see PoseUncertainty.
  std::vector<geometry::Matrix6d> Covariances(bool scale_is_free) const;
};

/// Bundle adjustment over the frames of one segment and all their tracks, then every frame's pose against the refined
/// points, also of frames in [before, after) that the tracking had not reached. The first pose and the distance of the
/// farthest stay. `frames` are all frames of the run. A track may come back as several points: long ones are cut.
void RefineSegment(const FinalRefinementOptions& options, const std::vector<Frame>& frames, int before, int after,
                   const std::function<void(double)>& progress, ThreadPool* pool, Segment* segment);

}  // namespace evo::odometry
