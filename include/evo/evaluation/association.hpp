#pragma once

#include <string>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/geometry/trajectory.hpp"

namespace evo::evaluation {

/// One estimated pose and where the camera truly was at that time.
struct PosePair {
  TimeNs t_estimate = 0;  ///< as written in the estimate
  TimeNs t_truth = 0;     ///< in the clock of the ground truth
  geometry::SE3 T_world_cam_estimate;
  geometry::SE3 T_world_cam_truth;
};

struct AssociationOptions {
  /// "interpolate": the truth is interpolated at each stamp of the estimate, never extrapolated.
  /// "nearest": evo's rule; the shorter trajectory is walked, each of its poses takes the nearest stamp of the longer
  /// one, and a stamp may be taken several times.
  /// "unique": that of TUM's evaluate_ate; the two stamps nearest to each other form a pair, then the nearest two of
  /// the rest, and so on: each stamp is taken once. "nearest-truth": that of TUM's evaluate_rpe; each estimated pose
  /// takes the nearest true one, several may take one. "index": for files without stamps, whose stamps are the numbers
  /// of their poses in s; the n-th pose of one belongs to the n-th of the other.
  std::string association = "interpolate";
  /// All but interpolate: stamps farther apart do not form a pair. Negative: what is usual, 0.01 for nearest, 0.02 for
  /// unique, twice the median interval of the truth for nearest-truth.
  double max_difference_s = -1.0;
  double max_interpolation_s = 0.5;    ///< interpolate: truth poses farther apart are a hole in the truth
  double estimate_clock_offset_s = 0;  ///< added to the estimate's stamps before they are compared
};

/// Pairs in order of time; empty where the trajectories do not overlap. O((n + m) log(n + m)). Throws Error (kInput)
/// where "index" meets two lengths.
std::vector<PosePair> Associate(const geometry::Trajectory& truth, const geometry::Trajectory& estimate,
                                const AssociationOptions& options);

}  // namespace evo::evaluation
