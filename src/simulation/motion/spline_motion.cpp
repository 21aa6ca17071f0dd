#include "simulation/motion/spline_motion.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <memory>
#include <vector>

#include "evo/core/error.hpp"

namespace evo::simulation {

namespace {

/// The cubic c1 u + c2 u^2 + c3 u^3 for u in [0, 1] with a given value and slope at its end and slope at its start
/// (Hermite form).
struct Cubic {
  Cubic(const Eigen::Vector3d& end, const Eigen::Vector3d& slope_start, const Eigen::Vector3d& slope_end)
      : c1(slope_start), c2(3.0 * end - 2.0 * slope_start - slope_end), c3(slope_start + slope_end - 2.0 * end) {}
  Eigen::Vector3d Evaluate(double u) const { return u * (c1 + u * (c2 + u * c3)); }

  Eigen::Vector3d c1, c2, c3;
};

/// The motion between two poses relative to the first: translation, and rotation vector in the first pose's frame.
struct Segment {
  TimeNs start = 0;
  double seconds = 0.0;
  geometry::SE3 first;
  Cubic translation;
  Cubic rotation;
};

/// The velocity at each pose of the parabola through it and its neighbours, at the ends the mean velocity of the
/// segment. `steps` are the differences between poses, `seconds` apart.
std::vector<Eigen::Vector3d> Velocities(const std::vector<Eigen::Vector3d>& steps, const std::vector<double>& seconds) {
  std::vector<Eigen::Vector3d> velocities{steps.front() / seconds.front()};
  for (std::size_t i = 1; i < steps.size(); ++i) {
    const double before = seconds[i - 1], after = seconds[i];
    velocities.emplace_back((steps[i - 1] / before * after + steps[i] / after * before) / (before + after));
  }
  velocities.emplace_back(steps.back() / seconds.back());
  return velocities;
}

std::vector<Segment> FitSegments(const geometry::Trajectory& trajectory) {
  const geometry::SE3 T_start_world = trajectory.front().T_world_cam.Inverse();
  std::vector<double> seconds;
  std::vector<Eigen::Vector3d> steps, rotations;
  std::vector<geometry::SE3> poses{geometry::SE3()};
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    seconds.push_back(ToSeconds(trajectory[i].t - trajectory[i - 1].t));
    poses.push_back(T_start_world * trajectory[i].T_world_cam);
    steps.emplace_back(poses[i].translation() - poses[i - 1].translation());
    rotations.push_back(geometry::so3::Log(poses[i - 1].rotation().conjugate() * poses[i].rotation()));
  }
  const auto velocities = Velocities(steps, seconds);
  // Angular velocities w in the camera's frame. With the rotation Exp(phi) since the segment's first pose,
  // dphi/dt = J_r(phi)^-1 w, where the right Jacobian J_r(phi) is the left one of -phi.
  const auto angular_velocities = Velocities(rotations, seconds);
  std::vector<Segment> segments;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const Eigen::Vector3d last_slope = geometry::so3::LeftJacobian(-rotations[i]).inverse() * angular_velocities[i + 1];
    segments.push_back({trajectory[i].t - trajectory.front().t, seconds[i], poses[i],
                        Cubic(steps[i], velocities[i] * seconds[i], velocities[i + 1] * seconds[i]),
                        Cubic(rotations[i], angular_velocities[i] * seconds[i], last_slope * seconds[i])});
  }
  return segments;
}

void CheckPoses(const geometry::Trajectory& trajectory) {
  if (trajectory.size() < 2) throw Error(ErrorKind::kInput, "a motion needs a trajectory of two poses or more");
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    if (i > 0 && trajectory[i].t <= trajectory[i - 1].t) {
      throw Error(ErrorKind::kInput,
                  fmt::format("a motion needs poses in order of time; pose {} at {} s is not after the one before",
                              i + 1, FormatTime(trajectory[i].t)));
    }
    if (!trajectory[i].T_world_cam.Matrix().allFinite()) {
      throw Error(ErrorKind::kInput, fmt::format("a motion needs finite poses; pose {} is not", i + 1));
    }
  }
}

}  // namespace

PoseFunction MakeSplineMotion(const geometry::Trajectory& trajectory) {
  CheckPoses(trajectory);
  const auto segments = std::make_shared<const std::vector<Segment>>(FitSegments(trajectory));
  const TimeNs duration = trajectory.back().t - trajectory.front().t;
  return [segments, duration](TimeNs t) -> geometry::SE3 {
    if (t < 0 || t > duration) {
      throw Error(
          ErrorKind::kNothingToDo,
          fmt::format("the trajectory to move along lasts from 0 s to {} s but a pose is needed at {} s; simulate a "
                      "shorter time",
                      FormatTime(duration), FormatTime(t)));
    }
    const auto next = std::ranges::upper_bound(segments->begin() + 1, segments->end(), t, {}, &Segment::start);
    const Segment& segment = *(next - 1);
    const double u = ToSeconds(t - segment.start) / segment.seconds;
    return {segment.first.rotation() * geometry::so3::Exp(segment.rotation.Evaluate(u)),
            segment.first.translation() + segment.translation.Evaluate(u)};
  };
}

}  // namespace evo::simulation
