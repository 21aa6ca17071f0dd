#pragma once

#include <vector>

#include "evo/core/time.hpp"
#include "evo/evaluation/matched_path.hpp"

namespace evo::evaluation {

struct LocalScaleOptions {
  double stretch_m = 10.0;  ///< path that a local scale is taken from, at most a fifth of the whole
};

/// The scale of the estimate around one pose.
struct ScaleSample {
  double seconds = 0.0;   ///< since `from`
  double distance = 0.0;  ///< m travelled, as in MatchedPath
  double ratio = 0.0;     ///< true by estimated size of the path there; 1 where the alignment's scale is right
};

/// Scale drift: a sample for each matched pose, from the poses within half a stretch of true path before and after it
/// but not beyond a gap (matched poses more than `longest_gap` apart), since after one the estimate may start anew with
/// another scale. The ratio is that of the root mean square distances of the true and of the aligned positions from
/// their centroids (B. K. P. Horn: Closed-form solution of absolute orientation using unit quaternions, JOSA A 1987,
/// section 2.E), which no drift in position or orientation enters and where, unlike in a ratio of path lengths, noise
/// does not add up from pose to pose.
///
/// NaN where less than a quarter of a stretch is left to judge by (a short piece between gaps, a camera that never
/// moves) and where the estimate does not move at all. A stop on the way keeps the scale of the motion around it. Near
/// the ends of the path and at gaps there is only one side to judge by.
std::vector<ScaleSample> ComputeLocalScale(const MatchedPath& path, TimeNs from, TimeNs longest_gap,
                                           const LocalScaleOptions& options);

}  // namespace evo::evaluation
