#include "evaluation/trajectory/path_frame.hpp"

#include <algorithm>
#include <cmath>

namespace evo::evaluation {

namespace {

constexpr double kMinNorm = 1e-9;  // below it a direction is noise

}  // namespace

Eigen::Vector3d UpDirection(const std::string& up, const geometry::Trajectory& truth) {
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

PathFrame::PathFrame(const geometry::Trajectory& truth, const Eigen::Vector3d& up, const std::string& forward,
                     double chord)
    : truth_(truth),
      up_(up),
      along_body_(forward == "body"),
      half_chord_(0.5 * chord),
      ground_positions_(GroundPositions()) {
  heading_ = ProjectToGround(truth.front().T_world_cam.rotation() * Eigen::Vector3d::UnitZ());
  // A camera that looks straight up or down and never moves has no heading.
  heading_ = heading_.norm() > kMinNorm ? heading_.normalized() : up.unitOrthogonal();
}

std::vector<Eigen::Vector3d> PathFrame::GroundPositions() const {
  std::vector<Eigen::Vector3d> positions;
  for (const auto& pose : truth_) positions.push_back(ProjectToGround(pose.T_world_cam.translation()));
  return positions;
}

Eigen::Vector3d PathFrame::Chord(TimeNs t, const Eigen::Vector3d& center) const {
  auto next = std::ranges::lower_bound(truth_, t, {}, &geometry::StampedPose::t);
  if (next == truth_.end()) --next;
  const auto ahead = static_cast<std::size_t>(next - truth_.begin());
  const std::size_t behind = next->t > t && ahead > 0 ? ahead - 1 : ahead;
  const auto& positions = ground_positions_.positions();
  return positions[ground_positions_.FirstOutside(ahead, center, half_chord_).value_or(positions.size() - 1)] -
         positions[ground_positions_.LastOutside(behind, center, half_chord_).value_or(0)];
}

PositionError PathFrame::Resolve(TimeNs t, const geometry::SE3& T_world_cam, const Eigen::Vector3d& estimate) {
  const Eigen::Vector3d error = estimate - T_world_cam.translation();
  if (along_body_) {
    const Eigen::Vector3d e = T_world_cam.rotation().conjugate() * error;
    return {e.z(), -e.x(), -e.y(), std::hypot(e.x(), e.z())};
  }
  const Eigen::Vector3d chord = Chord(t, ProjectToGround(T_world_cam.translation()));
  if (chord.norm() >= half_chord_) heading_ = chord.normalized();
  return {error.dot(heading_), error.dot(up_.cross(heading_)), error.dot(up_), ProjectToGround(error).norm()};
}

}  // namespace evo::evaluation
