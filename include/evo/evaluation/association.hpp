#pragma once

#include <string>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/geometry/trajectory.hpp"

namespace evo {

/// One estimated pose and where the camera truly was at that time.
struct PosePair {
  TimeNs t_estimate = 0;  ///< as written in the estimate
  TimeNs t_truth = 0;     ///< in the clock of the ground truth
  SE3 T_world_cam_estimate;
  SE3 T_world_cam_truth;
};

struct AssociationOptions {
  /// "interpolate": the truth is interpolated at each stamp of the estimate, never extrapolated.
  /// "nearest": evo's rule; the shorter trajectory is walked, each of its poses takes the nearest stamp of the longer
  /// one, and a stamp may be taken several times.
  std::string association = "interpolate";
  double max_difference_s = 0.01;      ///< nearest: stamps farther apart do not form a pair
  double max_interpolation_s = 0.5;    ///< interpolate: truth poses farther apart are a hole in the truth
  double estimate_clock_offset_s = 0;  ///< added to the estimate's stamps before they are compared
};

/// Pairs in order of time; empty where the trajectories do not overlap. O(n log m).
std::vector<PosePair> Associate(const Trajectory& truth, const Trajectory& estimate, const AssociationOptions& options);

}  // namespace evo
