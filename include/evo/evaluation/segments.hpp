#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "evo/core/parameters.hpp"
#include "evo/core/time.hpp"
#include "evo/evaluation/kitti_segments.hpp"
#include "evo/evaluation/matched_path.hpp"
#include "evo/evaluation/scale_drift.hpp"
#include "evo/evaluation/sub_trajectories.hpp"

namespace evo::evaluation {

struct SegmentOptions {
  std::string kitti_lengths_m = "100,200,300,400,500,600,700,800";  ///< see ParseLengths
  int kitti_step = 10;                                              ///< see ComputeKittiSegments
  std::string subtrajectory_lengths = "10%,20%,30%,40%,50%";        ///< see ParseLengths
  LocalScaleOptions local_scale;
};

void Register(Parameters& parameters, SegmentOptions& options);

/// What is said about stretches of a path.
struct SegmentEvaluation {
  KittiSegments kitti;
  std::vector<SubTrajectoryErrors> sub_trajectories;
  std::vector<ScaleSample> local_scale;  ///< one for each pose of the path
};

/// `path` holds one pose or more; `up` is a unit vector in the truth's world frame; `from` and `longest_gap` are those
/// of ComputeLocalScale. Shares of the path are those of its length along the matched true poses.
SegmentEvaluation EvaluateSegments(const MatchedPath& path, const Eigen::Vector3d& up, TimeNs from, TimeNs longest_gap,
                                   const SegmentOptions& options);

}  // namespace evo::evaluation
