#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/evaluation/position_search.hpp"
#include "evo/geometry/trajectory.hpp"

namespace evo::evaluation {

/// An error of position (estimate minus truth, m) as the driver would name it.
struct DrivingError {
  double longitudinal = 0.0;  ///< along the direction of travel, positive ahead of the truth
  double lateral = 0.0;       ///< across it in the ground plane, positive to its left
  double vertical = 0.0;      ///< positive above
  double planar = 0.0;        ///< length within the ground plane, never negative
};

/// Unit vector that points up in the world frame of `truth`. `up` is "x", "y", "z", "-x", "-y", "-z" or "auto": the
/// axis nearest to the mean of the camera's own up direction (its -y axis), which is -y for MVSEC (the world is the
/// first camera frame: x right, y down, z forward) and z for frames made by surveyors, as long as the camera is held
/// upright most of the time. A camera that looks down needs it given.
Eigen::Vector3d UpDirection(const std::string& up, const geometry::Trajectory& truth);

/// Splits errors of position along the truth's direction, which is one of
///
/// "travel": the chord, in the ground plane, from the last true position at least `chord` / 2 behind to the first at
/// least `chord` / 2 ahead (the ends of the truth where there is none), so that a standing or trembling camera keeps
/// the heading of the motion around its stop. Where even that chord is shorter than `chord` / 2 the heading of the pose
/// before is held; where nothing has moved yet it is the camera's view direction.
///
/// "body": the true camera's own axes, tilted as it is: longitudinal along its z, lateral along -x, vertical along -y,
/// and planar in its plane of x and z.
class DrivingFrame {
 public:
  /// `truth` must outlive this object and hold one pose or more; `up` is a unit vector, `chord` in m and positive.
  DrivingFrame(const geometry::Trajectory& truth, const Eigen::Vector3d& up, const std::string& forward, double chord);

  /// `T_world_cam` is the true pose at `t`, which is within the truth; `estimate` the estimated position in the truth's
  /// world frame. Calls go forward in time: headings are held from call to call.
  DrivingError Split(TimeNs t, const geometry::SE3& T_world_cam, const Eigen::Vector3d& estimate);

 private:
  Eigen::Vector3d Flatten(const Eigen::Vector3d& v) const { return v - v.dot(up_) * up_; }
  std::vector<Eigen::Vector3d> FlatPositions() const;
  Eigen::Vector3d Chord(TimeNs t, const Eigen::Vector3d& center) const;

  const geometry::Trajectory& truth_;
  Eigen::Vector3d up_;
  bool along_body_;
  double half_chord_;
  PositionSearch search_;    // in the ground plane
  Eigen::Vector3d heading_;  // unit vector in the ground plane
};

}  // namespace evo::evaluation
