#include "evo/geometry/trajectory.hpp"

#include <algorithm>

namespace evo::geometry {

std::optional<SE3> PoseAt(const Trajectory& trajectory, TimeNs t, TimeNs max_interval) {
  const auto after = std::ranges::lower_bound(trajectory, t, {}, &StampedPose::t);
  if (after == trajectory.end()) return std::nullopt;
  if (after->t == t) return after->T_world_cam;
  if (after == trajectory.begin()) return std::nullopt;
  const auto before = after - 1;
  const TimeNs interval = after->t - before->t;
  if (interval > max_interval) return std::nullopt;
  return Interpolate(before->T_world_cam, after->T_world_cam, ToSeconds(t - before->t) / ToSeconds(interval));
}

double PathLength(const Trajectory& trajectory) {
  double length = 0.0;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    length += (trajectory[i].T_world_cam.translation() - trajectory[i - 1].T_world_cam.translation()).norm();
  }
  return length;
}

}  // namespace evo::geometry
