#include <algorithm>
#include <memory>

#include "evo/core/error.hpp"
#include "evo/simulation/motion.hpp"

namespace evo::simulation {

namespace {

/// The polynomial c1 u + c2 u^2 + c3 u^3 for u in [0, 1] with given end value and end slopes (Hermite).
struct Cubic {
  Cubic(const Eigen::Vector3d& end, const Eigen::Vector3d& slope_start, const Eigen::Vector3d& slope_end)
      : c1(slope_start), c2(3.0 * end - 2.0 * slope_start - slope_end), c3(slope_start + slope_end - 2.0 * end) {}
  Eigen::Vector3d At(double u) const { return u * (c1 + u * (c2 + u * c3)); }

  Eigen::Vector3d c1, c2, c3;
};

/// Between two poses, from the first: the translation and, as axis times angle in the first pose's frame, the rotation.
struct Stretch {
  TimeNs start = 0;
  double seconds = 0.0;
  geometry::SE3 first;
  Cubic translation;
  Cubic rotation;
};

/// The slope at each pose of the parabola through it and its neighbours; at the ends that of the neighbouring stretch.
/// `steps` are the ways between poses in `seconds`.
std::vector<Eigen::Vector3d> Velocities(const std::vector<Eigen::Vector3d>& steps, const std::vector<double>& seconds) {
  std::vector<Eigen::Vector3d> velocities{steps.front() / seconds.front()};
  for (std::size_t i = 1; i < steps.size(); ++i) {
    const double before = seconds[i - 1], after = seconds[i];
    velocities.emplace_back((steps[i - 1] / before * after + steps[i] / after * before) / (before + after));
  }
  velocities.emplace_back(steps.back() / seconds.back());
  return velocities;
}

std::vector<Stretch> Fit(const geometry::Trajectory& trajectory) {
  const geometry::SE3 T_start_world = trajectory.front().T_world_cam.Inverse();
  std::vector<double> seconds;
  std::vector<Eigen::Vector3d> steps, turns;
  std::vector<geometry::SE3> poses{geometry::SE3()};
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    seconds.push_back(ToSeconds(trajectory[i].t - trajectory[i - 1].t));
    poses.push_back(T_start_world * trajectory[i].T_world_cam);
    steps.emplace_back(poses[i].translation() - poses[i - 1].translation());
    turns.push_back(geometry::so3::Log(poses[i - 1].rotation().conjugate() * poses[i].rotation()));
  }
  const auto velocities = Velocities(steps, seconds);
  // Rates in the camera's own frame. Where the rotation since the stretch's first pose is Exp(phi) and the rate w,
  // phi changes by the inverse of the right Jacobian, that is the left one of -phi, times w.
  const auto rates = Velocities(turns, seconds);
  std::vector<Stretch> stretches;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const Eigen::Vector3d last_slope = geometry::so3::LeftJacobian(-turns[i]).inverse() * rates[i + 1];
    stretches.push_back({trajectory[i].t - trajectory.front().t, seconds[i], poses[i],
                         Cubic(steps[i], velocities[i] * seconds[i], velocities[i + 1] * seconds[i]),
                         Cubic(turns[i], rates[i] * seconds[i], last_slope * seconds[i])});
  }
  return stretches;
}

void Check(const geometry::Trajectory& trajectory) {
  if (trajectory.size() < 2) throw Error(ErrorKind::kInput, "a motion needs a trajectory of two poses or more");
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    if (i > 0 && trajectory[i].t <= trajectory[i - 1].t) {
      throw Error(ErrorKind::kInput, "a motion needs poses in order of time; pose " + std::to_string(i + 1) + " at " +
                                         FormatTime(trajectory[i].t) + " s is not after the one before");
    }
    if (!trajectory[i].T_world_cam.Matrix().allFinite()) {
      throw Error(ErrorKind::kInput, "a motion needs finite poses; pose " + std::to_string(i + 1) + " is not");
    }
  }
}

}  // namespace

CameraMotion MakeMotionThrough(const geometry::Trajectory& trajectory) {
  Check(trajectory);
  const auto stretches = std::make_shared<const std::vector<Stretch>>(Fit(trajectory));
  const TimeNs duration = trajectory.back().t - trajectory.front().t;
  return [stretches, duration](TimeNs t) -> geometry::SE3 {
    if (t < 0 || t > duration) {
      throw Error(ErrorKind::kNothingToDo, "the trajectory to move along lasts from 0 s to " + FormatTime(duration) +
                                               " s but a pose is needed at " + FormatTime(t) +
                                               " s; simulate a shorter time");
    }
    const auto next = std::ranges::upper_bound(stretches->begin() + 1, stretches->end(), t, {}, &Stretch::start);
    const Stretch& stretch = *(next - 1);
    const double u = ToSeconds(t - stretch.start) / stretch.seconds;
    return {stretch.first.rotation() * geometry::so3::Exp(stretch.rotation.At(u)),
            stretch.first.translation() + stretch.translation.At(u)};
  };
}

}  // namespace evo::simulation
