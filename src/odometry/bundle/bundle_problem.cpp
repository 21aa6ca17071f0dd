#include "odometry/bundle/bundle_problem.hpp"

#include <algorithm>

namespace evo::odometry {

Eigen::Vector3d WorldPosition(const BundleProblem& problem, const BundlePoint& point) {
  return problem.T_cam_world[point.anchor].Inverse() *
         Eigen::Vector3d(point.inverse_depth.head<2>().homogeneous() / point.inverse_depth.z());
}

std::vector<std::size_t> FirstObservations(const BundleProblem& problem) {
  std::vector<std::size_t> begin(problem.points.size() + 1, problem.observations.size());
  for (std::size_t i = problem.observations.size(); i-- > 0;) begin[problem.observations[i].point] = i;
  for (std::size_t p = problem.points.size(); p-- > 0;) begin[p] = std::min(begin[p], begin[p + 1]);
  return begin;
}

std::vector<int> ReducedSystemSkyline(const BundleProblem& problem) {
  const int poses = std::max(0, static_cast<int>(problem.T_cam_world.size()) - problem.fixed_frames);
  std::vector<int> first_columns(static_cast<std::size_t>(poses));
  for (int i = 0; i < poses; ++i) first_columns[i] = problem.motion.times_s.empty() ? i : std::max(0, i - 2);
  int point = -1;
  int first_pose = 0;                                     // that sees the point
  for (const auto& observation : problem.observations) {  // in order of points, then of frames
    const int pose = observation.frame - problem.fixed_frames;
    if (pose < 0) continue;
    if (observation.point != point) {
      point = observation.point;
      first_pose = pose;
    }
    first_columns[pose] = std::min(first_columns[pose], first_pose);
  }
  return first_columns;
}

}  // namespace evo::odometry
