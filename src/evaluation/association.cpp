#include "evo/evaluation/association.hpp"

#include <algorithm>
#include <cstdlib>

namespace evo {

namespace {

/// `stamps` is not empty; of two stamps equally near, the earlier.
std::size_t NearestPose(const Trajectory& trajectory, TimeNs t) {
  const auto after = std::ranges::lower_bound(trajectory, t, {}, &StampedPose::t);
  if (after == trajectory.begin()) return 0;
  const auto before = after - 1;
  const bool take_after = after != trajectory.end() && after->t - t < t - before->t;
  return static_cast<std::size_t>((take_after ? after : before) - trajectory.begin());
}

std::vector<PosePair> PairWithNearest(const Trajectory& truth, const Trajectory& estimate, TimeNs offset,
                                      TimeNs max_difference) {
  std::vector<PosePair> pairs;
  const bool walk_truth = estimate.size() > truth.size();
  const Trajectory& shorter = walk_truth ? truth : estimate;
  const Trajectory& longer = walk_truth ? estimate : truth;
  const TimeNs to_longer = walk_truth ? -offset : offset;
  for (const auto& pose : shorter) {
    const auto& nearest = longer[NearestPose(longer, pose.t + to_longer)];
    if (std::abs(nearest.t - (pose.t + to_longer)) > max_difference) continue;
    const auto& truth_pose = walk_truth ? pose : nearest;
    const auto& estimate_pose = walk_truth ? nearest : pose;
    pairs.push_back({estimate_pose.t, truth_pose.t, estimate_pose.T_world_cam, truth_pose.T_world_cam});
  }
  return pairs;
}

std::vector<PosePair> PairWithInterpolated(const Trajectory& truth, const Trajectory& estimate, TimeNs offset,
                                           TimeNs max_interval) {
  std::vector<PosePair> pairs;
  for (const auto& pose : estimate) {
    const TimeNs t = pose.t + offset;
    const auto T_world_cam_truth = PoseAt(truth, t, max_interval);
    if (T_world_cam_truth) pairs.push_back({pose.t, t, pose.T_world_cam, *T_world_cam_truth});
  }
  return pairs;
}

}  // namespace

std::vector<PosePair> Associate(const Trajectory& truth, const Trajectory& estimate,
                                const AssociationOptions& options) {
  if (truth.empty() || estimate.empty()) return {};
  const TimeNs offset = FromSeconds(options.estimate_clock_offset_s);
  return options.association == "nearest"
             ? PairWithNearest(truth, estimate, offset, FromSeconds(options.max_difference_s))
             : PairWithInterpolated(truth, estimate, offset, FromSeconds(options.max_interpolation_s));
}

}  // namespace evo
