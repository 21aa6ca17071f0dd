#pragma once

#include <span>
#include <vector>

#include "evo/evaluation/matched_path.hpp"
#include "evo/evaluation/statistics.hpp"

namespace evo::evaluation {

/// Errors over all segments of one length.
struct KittiLength {
  double length_m = 0.0;
  Statistics translation_percent;  ///< error of position at the segment's end in % of `length_m`
  Statistics rotation_deg_per_m;   ///< error of orientation there by `length_m`
};

struct KittiSegments {
  int step = 0;                      ///< poses from start to start
  std::vector<KittiLength> lengths;  ///< in the order asked for; a length without any segment is left out
  /// Over all segments of all lengths, the means being the two figures of KITTI's table; NaN where there is none.
  Statistics translation_percent, rotation_deg_per_m;
};

/// Segment errors of the KITTI odometry benchmark (A. Geiger, P. Lenz, R. Urtasun: Are we ready for Autonomous
/// Driving? CVPR 2012, section 3.2, and its development kit): from every `step`-th pose (1 or more) a segment of each
/// of `lengths_m` (m, positive) to the first pose at which the truth has gone farther than that. Distances are taken
/// along the matched true poses. The kit computes in single precision, in which small errors over long paths lose
/// digits; here it is double precision.
///
/// KITTI knows no alignment beyond the first pose, to which these errors are blind, as to any rigid motion of either
/// path; they are not blind to scale, so `path` is to be aligned with scale where a single camera made it.
KittiSegments ComputeKittiSegments(const MatchedPath& path, std::span<const double> lengths_m, int step);

}  // namespace evo::evaluation
