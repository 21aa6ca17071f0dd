#include "evaluation/trajectory/segments.hpp"

#include "evaluation/trajectory/kitti_segments.hpp"
#include "evaluation/trajectory/local_scale.hpp"
#include "evaluation/trajectory/sub_trajectories.hpp"

namespace evo::evaluation {

SegmentErrors EvaluateSegments(const MatchedTrajectory& trajectory, const Eigen::Vector3d& up, TimeNs from,
                               TimeNs max_gap, const SegmentOptions& options) {
  const double path_m = trajectory.distance.back();
  return {ComputeKittiSegments(trajectory, ParseLengths(options.kitti_lengths_m, path_m), options.kitti_step),
          ComputeSubTrajectoryErrors(trajectory, ParseLengths(options.subtrajectory_lengths, path_m), up),
          ComputeLocalScale(trajectory, from, max_gap, options.scale_segment_m)};
}

}  // namespace evo::evaluation
