#pragma once

#include <span>

#include "evaluation/trajectory/matched_trajectory.hpp"
#include "evo/evaluation/trajectory_errors.hpp"

namespace evo::evaluation {

/// Segment errors of the KITTI odometry benchmark (A. Geiger, P. Lenz, R. Urtasun: Are we ready for Autonomous
/// Driving? CVPR 2012, section 3.2, and its development kit). From every `step`-th pose (1 or more) a segment of each
/// of `lengths_m` (m, positive) ends at the first pose at which the truth has travelled farther than that. The kit
/// computes in single precision, in which small errors over long paths lose digits; this is double precision.
///
/// KITTI aligns nothing beyond the first pose. The errors do not depend on rigid motions of either path, but they
/// depend on scale, so a monocular trajectory must be aligned with scale.
KittiSegments ComputeKittiSegments(const MatchedTrajectory& trajectory, std::span<const double> lengths_m, int step);

}  // namespace evo::evaluation
