#pragma once

#include <Eigen/Core>

#include "evaluation/trajectory/matched_trajectory.hpp"
#include "evo/core/time.hpp"
#include "evo/evaluation/evaluation_options.hpp"
#include "evo/evaluation/trajectory_errors.hpp"

namespace evo::evaluation {

/// Errors over segments of a trajectory of at least one pose. `up` is a unit vector in the truth's world frame; `from`
/// and `max_gap` are those of ComputeLocalScale. Lengths in percent refer to the path along the matched true positions.
SegmentErrors EvaluateSegments(const MatchedTrajectory& trajectory, const Eigen::Vector3d& up, TimeNs from,
                               TimeNs max_gap, const SegmentOptions& options);

}  // namespace evo::evaluation
