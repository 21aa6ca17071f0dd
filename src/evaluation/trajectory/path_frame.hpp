#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "evaluation/trajectory/position_hierarchy.hpp"
#include "evo/core/time.hpp"
#include "evo/evaluation/trajectory_errors.hpp"
#include "evo/geometry/trajectory.hpp"

namespace evo::evaluation {

/// Unit vector that points up in the world frame of `truth`. `up` is "x", "y", "z", "-x", "-y", "-z" or "auto": the
/// axis nearest to the mean of the camera's own up direction (its -y axis). That is -y for MVSEC (the world is the
/// first camera frame: x right, y down, z forward) and z for surveyed frames, as long as the camera is mostly upright.
/// A camera that looks down needs an explicit axis.
Eigen::Vector3d UpDirection(const std::string& up, const geometry::Trajectory& truth);

/// The moving frame along the true path (a Frenet frame with a fixed up direction) that resolves position errors.
///
/// "travel": the tangent is the chord, in the ground plane, from the last true position at least `chord` / 2 behind to
/// the first at least `chord` / 2 ahead, or to the end of the truth. A camera that stands or trembles keeps the heading
/// of the motion around its stop: a chord shorter than `chord` / 2 repeats the heading of the pose before. Before any
/// motion the heading is the camera's view direction.
///
/// "body": the axes of the true camera, with its tilt: longitudinal along z, lateral along -x, vertical along -y,
/// planar in the plane of x and z.
class PathFrame {
 public:
  /// `truth` must outlive this object and hold at least one pose; `up` is a unit vector, `chord` is positive (m).
  PathFrame(const geometry::Trajectory& truth, const Eigen::Vector3d& up, const std::string& forward, double chord);

  /// Resolves the error of `estimate`, a position in the truth's world frame. `T_world_cam` is the true pose at `t`,
  /// which lies within the truth. Calls must go forward in time because the heading is kept from call to call.
  PositionError Resolve(TimeNs t, const geometry::SE3& T_world_cam, const Eigen::Vector3d& estimate);

 private:
  Eigen::Vector3d ProjectToGround(const Eigen::Vector3d& v) const { return v - v.dot(up_) * up_; }
  std::vector<Eigen::Vector3d> GroundPositions() const;
  Eigen::Vector3d Chord(TimeNs t, const Eigen::Vector3d& center) const;

  const geometry::Trajectory& truth_;
  Eigen::Vector3d up_;
  bool along_body_;
  double half_chord_;
  PositionHierarchy ground_positions_;
  Eigen::Vector3d heading_;  // unit vector in the ground plane
};

}  // namespace evo::evaluation
