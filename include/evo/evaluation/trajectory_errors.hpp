#pragma once

#include <string>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/evaluation/delta.hpp"
#include "evo/evaluation/pose_relation.hpp"
#include "evo/evaluation/statistics.hpp"

namespace evo::evaluation {

/// Position error (estimate minus truth, m) in the path frame: tangent of the true path, left and up. See PathFrame.
struct PositionError {
  double longitudinal = 0.0;  ///< along the direction of travel, positive ahead of the truth
  double lateral = 0.0;       ///< across it in the ground plane, positive to the left
  double vertical = 0.0;      ///< positive above
  double planar = 0.0;        ///< length within the ground plane, never negative
};

/// Absolute errors of one aligned pose.
struct PoseError {
  TimeNs stamp = 0;       ///< as in the estimate
  double seconds = 0.0;   ///< since the start of the evaluated interval
  double distance = 0.0;  ///< travelled by the truth since the first matched pose (m)
  PositionError position;
  double translation = 0.0;  ///< length of the position error (m)
  double rotation_deg = 0.0;
};

/// One component of the position error over all poses (m).
struct ErrorSummary {
  double mean_abs = 0.0;
  double rmse = 0.0;
  double max_abs = 0.0;
  double final = 0.0;  ///< at the last pose, signed
  /// Mean of absolute error / distance travelled. Poses within the first metre do not count; NaN if no other is left.
  double mean_over_distance = 0.0;
};

/// Relative pose errors over one delta; count 0 and NaN without pairs.
struct RelativePoseError {
  Delta delta;
  std::string pairs;                          ///< rule that selected the pairs, see SelectPairs
  std::vector<RelationStatistics> relations;  ///< kRelativeRelations
};

/// Normalised estimation error squared (NEES) over the degrees of freedom: e^T C^-1 e / n for the error e and its
/// covariance C (Y. Bar-Shalom, X. R. Li, T. Kirubarajan: Estimation with Applications to Tracking and Navigation,
/// 2001, section 5.4). The mean is 1 for consistent covariances and larger for optimistic ones. The errors of one run
/// are correlated, so the mean scatters far more than the number of poses suggests.
struct Nees {
  Statistics translation;
  Statistics rotation;
  Statistics pose;  ///< translation and rotation with their correlation
};

/// Errors over all KITTI segments of one length.
struct KittiLength {
  double length_m = 0.0;
  Statistics translation_percent;  ///< position error at the segment's end over `length_m`
  Statistics rotation_deg_per_m;   ///< rotation error at the segment's end over `length_m`
};

/// Segment errors of the KITTI odometry benchmark, see ComputeKittiSegments.
struct KittiSegments {
  int step = 0;                      ///< poses between the starts of segments
  std::vector<KittiLength> lengths;  ///< in the order of the parameter, without lengths that have no segment
  /// Over all segments of all lengths; their means are the two numbers of KITTI's table. NaN without segments.
  Statistics translation_percent, rotation_deg_per_m;
};

/// Errors at the ends of all sub-trajectories of one length, see ComputeSubTrajectoryErrors.
struct SubTrajectoryErrors {
  double length_m = 0.0;
  Statistics translation_m;
  Statistics translation_percent;  ///< of `length_m`
  Statistics rotation_deg;
  Statistics rotation_deg_per_m;  ///< over `length_m`
  Statistics yaw_deg;             ///< rotation error about the up direction
  Statistics gravity_deg;         ///< the remaining tilt: root of pitch squared plus roll squared
};

/// Local scale of the estimate around one pose, see ComputeLocalScale.
struct ScaleSample {
  double seconds = 0.0;   ///< since the start of the evaluated interval
  double distance = 0.0;  ///< along the matched true positions (m)
  double ratio = 0.0;  ///< true over aligned size of the path; 1 where the alignment's scale holds, NaN if undetermined
};

/// Errors over segments of the path.
struct SegmentErrors {
  KittiSegments kitti;
  std::vector<SubTrajectoryErrors> sub_trajectories;
  std::vector<ScaleSample> local_scale;  ///< one for each matched pose
};

}  // namespace evo::evaluation
