#pragma once

#include <vector>

#include "evo/core/time.hpp"
#include "evo/evaluation/evaluation_options.hpp"
#include "evo/geometry/trajectory.hpp"

namespace evo::evaluation {

/// An estimated pose and the true pose at its time.
struct PosePair {
  TimeNs t_estimate = 0;  ///< as in the estimate
  TimeNs t_truth = 0;     ///< in the clock of the ground truth
  geometry::SE3 T_world_cam_estimate;
  geometry::SE3 T_world_cam_truth;
};

/// Matches estimated and true poses by their stamps, the estimate's moved by `estimate_clock_offset_s`:
///
/// "interpolate": the truth is interpolated at each stamp of the estimate, never extrapolated, and not between true
/// poses that are more than `max_interpolation_s` apart.
/// "nearest" (evo): each pose of the shorter trajectory takes the nearest stamp of the longer one; a stamp may be taken
/// several times.
/// "unique" (TUM's evaluate_ate): the two stamps nearest to each other form a pair, then the nearest two of the rest,
/// and so on; each stamp is taken once.
/// "nearest-truth" (TUM's evaluate_rpe): each estimated pose takes the nearest true one; several may take the same.
/// "index": for files without stamps; the n-th pose of one belongs to the n-th of the other.
///
/// All but "interpolate" and "index" form no pair of stamps more than `max_difference_s` apart. A negative value means
/// the default of the original tool: 0.01 s for nearest, 0.02 s for unique, twice the median interval of the truth for
/// nearest-truth.
///
/// Returns pairs in order of time, none if the trajectories do not overlap, in O((n + m) log(n + m)). Throws Error
/// (kInput) if "index" meets two lengths.
std::vector<PosePair> Associate(const geometry::Trajectory& truth, const geometry::Trajectory& estimate,
                                const AssociationOptions& options);

}  // namespace evo::evaluation
