#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "evaluation/trajectory/matched_trajectory.hpp"
#include "evo/evaluation/trajectory_errors.hpp"

namespace evo::evaluation {

/// Relative errors of rpg_trajectory_evaluation (Z. Zhang, D. Scaramuzza: A Tutorial on Quantitative Trajectory
/// Evaluation for Visual(-Inertial) Odometry, IROS 2018, section IV.C). From every pose a sub-trajectory of each of
/// `lengths_m` (m, positive) ends at the pose whose travelled distance is nearest to that length, the earlier of two
/// equally near; there is none if that pose is 20 % off or more. Distances accumulate along the matched true positions.
/// A length without sub-trajectories is dropped.
///
/// The rotation error, seen in the world frame, is R_up(yaw) R_side(pitch) R_front(roll); `up` (unit vector in the
/// truth's world frame) plays the role of that program's z. Two differences from the program:
/// - It uses the estimate's own world frame, before alignment, where z is up only by convention. Here the aligned
///   estimate is used, so yaw and gravity agree only if the alignment has no rotation; translation and rotation always
///   agree.
/// - It assumes that only the last poses find no end. If an earlier pose finds none (the truth jumps by more than 20 %
///   of the length), it compares poses that do not belong together; here the pose is skipped.
std::vector<SubTrajectoryErrors> ComputeSubTrajectoryErrors(const MatchedTrajectory& trajectory,
                                                            std::span<const double> lengths_m,
                                                            const Eigen::Vector3d& up);

}  // namespace evo::evaluation
