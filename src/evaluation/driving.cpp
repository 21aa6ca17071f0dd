#include "evo/evaluation/driving.hpp"

#include <algorithm>

namespace evo {

namespace {

constexpr double kShortest = 1e-9;  // of a direction that can be normalised

/// An arbitrary unit vector perpendicular to `up`, for a camera that looks straight up or down and never moves.
Eigen::Vector3d AnyHeading(const Eigen::Vector3d& up) { return up.unitOrthogonal(); }

}  // namespace

Eigen::Vector3d UpDirection(const std::string& up, const Trajectory& truth) {
  if (up != "auto") {
    const double sign = up.front() == '-' ? -1.0 : 1.0;
    return sign * Eigen::Vector3d::Unit(up.back() - 'x');
  }
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& pose : truth) mean -= pose.T_world_cam.rotation() * Eigen::Vector3d::UnitY();
  Eigen::Index axis = 0;
  mean.cwiseAbs().maxCoeff(&axis);
  return (mean[axis] < 0.0 ? -1.0 : 1.0) * Eigen::Vector3d::Unit(axis);
}

DrivingFrame::DrivingFrame(const Trajectory& truth, const Eigen::Vector3d& up, double chord)
    : truth_(truth), up_(up), half_chord_(0.5 * chord) {
  heading_ = Flatten(truth.front().T_world_cam.rotation() * Eigen::Vector3d::UnitZ());
  heading_ = heading_.norm() > kShortest ? heading_.normalized() : AnyHeading(up);
}

DrivingError DrivingFrame::Split(TimeNs t, const Eigen::Vector3d& truth, const Eigen::Vector3d& estimate) {
  const auto far_enough = [&](const StampedPose& pose) {
    return Flatten(pose.T_world_cam.translation() - truth).norm() >= half_chord_;
  };
  auto ahead = std::ranges::lower_bound(truth_, t, {}, &StampedPose::t);
  if (ahead == truth_.end()) --ahead;
  auto behind = ahead->t > t && ahead != truth_.begin() ? ahead - 1 : ahead;
  while (ahead + 1 != truth_.end() && !far_enough(*ahead)) ++ahead;
  while (behind != truth_.begin() && !far_enough(*behind)) --behind;
  const Eigen::Vector3d chord = Flatten(ahead->T_world_cam.translation() - behind->T_world_cam.translation());
  if (chord.norm() >= half_chord_) heading_ = chord.normalized();

  const Eigen::Vector3d error = estimate - truth;
  return {error.dot(heading_), error.dot(up_.cross(heading_)), error.dot(up_), Flatten(error).norm()};
}

}  // namespace evo
