#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "evo/evaluation/matched_path.hpp"
#include "evo/evaluation/statistics.hpp"

namespace evo::evaluation {

/// Errors at the ends of all sub-trajectories of one length.
struct SubTrajectoryErrors {
  double length_m = 0.0;
  Statistics translation_m;
  Statistics translation_percent;  ///< of `length_m`
  Statistics rotation_deg;
  Statistics rotation_deg_per_m;  ///< by `length_m`
  Statistics yaw_deg;             ///< turn of the error about `up`
  Statistics gravity_deg;         ///< the rest of it: root of pitch squared plus roll squared
};

/// Relative errors as rpg_trajectory_evaluation takes them (Z. Zhang, D. Scaramuzza: A Tutorial on Quantitative
/// Trajectory Evaluation for Visual(-Inertial) Odometry, IROS 2018, section IV.C): from every pose a sub-trajectory of
/// each of `lengths_m` (m, positive) to the pose whose distance travelled is nearest to that length (the earlier of two
/// equally near); there is none where it would be 20 % off or more. Distances are taken along the matched true poses. A
/// length without any sub-trajectory is left out.
///
/// The error's rotation, seen in the world frame, is split as R_up(yaw) R_side(pitch) R_front(roll), where `up` (unit
/// vector in the truth's world frame) plays the role of that program's z. Two differences from the program:
/// - It looks at the estimate's own world frame, before alignment, where its z is up only by agreement. Here the
///   aligned estimate is looked at, so yaw and gravity are the same only where the alignment has no rotation;
///   translation and rotation are the same always.
/// - It assumes that only the last poses find no end. Where one before them finds none (a jump of the truth by more
///   than 20 % of the length), it compares with poses that do not belong together; here the pose is passed over.
std::vector<SubTrajectoryErrors> ComputeSubTrajectoryErrors(const MatchedPath& path, std::span<const double> lengths_m,
                                                            const Eigen::Vector3d& up);

}  // namespace evo::evaluation
