#pragma once

#include <vector>

#include "evaluation/trajectory/matched_trajectory.hpp"
#include "evo/core/time.hpp"
#include "evo/evaluation/trajectory_errors.hpp"

namespace evo::evaluation {

/// Local scale at each matched pose, from a window of `segment_m` of true path around it (m, at most a fifth of the
/// whole). The window ends at gaps (matched poses more than `max_gap` apart), since the odometry may reinitialise there
/// with another scale. `from` is the start of the evaluated interval.
///
/// The ratio is that of the root mean square distances of the true and the aligned positions from their centroids
/// (B. K. P. Horn: Closed-form solution of absolute orientation using unit quaternions, JOSA A 1987, section 2.E). It
/// does not depend on drift in position or orientation, and noise does not accumulate as in a ratio of path lengths.
///
/// NaN if the window holds less than a quarter of the segment (a short piece between gaps, a camera that never moves)
/// or if the estimate does not move. A stop keeps the scale of the motion around it. Near the ends of the path and at
/// gaps the window is one-sided.
std::vector<ScaleSample> ComputeLocalScale(const MatchedTrajectory& trajectory, TimeNs from, TimeNs max_gap,
                                           double segment_m);

}  // namespace evo::evaluation
