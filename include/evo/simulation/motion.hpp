#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "evo/core/parameters.hpp"
#include "evo/core/random.hpp"
#include "evo/geometry/trajectory.hpp"
#include "evo/simulation/scene.hpp"

namespace evo::simulation {

// Where roads lead and how cameras move: pure functions of distance or time, continuous in velocity, safe to call from
// many threads at once. Equal options and seeds give equal motion.

/// The line that the road follows: heading, slope and position over the distance travelled (length along the line,
/// hills included). Made of straight pieces, arcs and clothoids, so that the curvature is continuous and a car can
/// drive it.
class RoadLine {
 public:
  struct Point {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< on the road's surface, x right, y down, z forward, m
    double heading = 0.0;                                ///< rad, 0 along +z, positive to the right (+x)
    double pitch = 0.0;                                  ///< rad, slope of the road, positive uphill
    double curvature = 0.0;                              ///< of the heading, 1/m, positive to the right
  };
  /// Starts at the origin, level and along +z. `shape` is "straight", "curved" (bends of 60 m to 300 m radius) or
  /// "turns" (up to four right-angle turns of 8 m radius at crossings about 80 m apart, the first after about 40 m; as
  /// many as `length_m` holds). With `slope` > 0 there are hills: smooth sums of sines, at most so steep (rise / run).
  /// Never comes near an earlier part of itself. Error (kConfiguration) where the shape is unknown or a number makes no
  /// sense.
  RoadLine(const std::string& shape, double length_m, double slope, std::uint64_t seed);

  double length() const { return length_; }
  /// Before 0 the line goes on straight; after length() it ends the bend that it is in and goes on straight.
  Point At(double distance_m) const;
  /// Distances at which the middle of a crossing lies, increasing, within [0, length()]. On "turns" these are the
  /// middles of the turns; else they lie on straight pieces.
  const std::vector<double>& crossings() const { return crossings_; }

 private:
  /// A piece of the line in which the curvature changes linearly with the distance.
  struct Piece {
    double start = 0.0;
    double length = 0.0;
    double curvature_start = 0.0;
    double curvature_end = 0.0;
    double heading_start = 0.0;
  };
  struct Wave {
    double wavenumber = 0.0;  ///< rad/m
    double phase = 0.0;
    double slope = 0.0;
  };
  struct Node {
    Eigen::Vector3d position;
    Eigen::Vector3d tangent;
  };

  void Append(double length, double curvature_start, double curvature_end);
  /// A bend by `angle` (rad, positive to the right): clothoid, arc, clothoid.
  void AppendBend(double angle, double radius, double clothoid);
  void LayCurves(Random* random);
  void LayTurns(Random* random);
  void LayCrossings(Random* random);
  void LayHills(double slope, Random* random);
  void Integrate();
  /// Heading, pitch and curvature, without the position.
  Point Direction(double distance) const;
  double end() const { return pieces_.back().start + pieces_.back().length; }

  double length_ = 0.0;
  std::vector<double> crossings_;
  std::vector<Piece> pieces_;
  std::vector<Wave> hills_;
  std::vector<Node> nodes_;
  double node_spacing_ = 0.0;
};

struct VehicleOptions {
  double duration_s = 60.0;
  double speed_m_s = 7.5;          ///< cruising
  double acceleration_m_s2 = 1.5;  ///< most of it, speeding up and braking
  double stop_every_s = 0.0;       ///< brake to a stop, stand, start again; 0: never
  double stand_s = 2.0;
  double start_at_rest_s = 1.0;  ///< stands so long at the start; 0: starts at cruising speed
  double turn_speed_m_s = 4.0;   ///< in right-angle turns; gentler bends are taken at the same lateral acceleration
  double camera_height_m = 1.5;
  double camera_pitch_deg = 0.0;  ///< positive: looks down
  double vibration_deg = 0.05;    ///< standard deviation of the engine's and the road's small rotations about each axis
  double vibration_hz = 12.0;
  std::string bumps_at_s;       ///< "52,60": times; or "every 5": one every 5 s
  double bump_pitch_deg = 2.0;  ///< peaks of the damped oscillation
  double bump_heave_m = 0.06;
  double bump_roll_deg = 0.7;
};

/// Names motion.vehicle.*.
void Register(Parameters& parameters, VehicleOptions& options);

/// Times of the bumps within [0, duration_s], increasing. Error (kConfiguration) if the text cannot be read.
std::vector<double> BumpTimes(const VehicleOptions& options);

/// Distance along the road over time (m) and the pose of the camera.
struct VehicleMotion {
  CameraMotion T_world_cam;
  std::function<double(TimeNs)> distance_m;
};

/// The camera follows the road's heading and slope; bumps shake it only if it moves. At time 0 its position is the
/// origin and its rotation the identity but for camera_pitch_deg: a point of the road lies in the world at
/// RoadLine::Point::position plus camera_height_m in y. Stops at the road's end. Before 0 and after duration_s it keeps
/// its velocity. Error (kConfiguration) for an impossible option.
VehicleMotion MakeVehicleMotion(const RoadLine& road, const VehicleOptions& options, std::uint64_t seed);

struct HandheldOptions {
  double duration_s = 20.0;
  double translation_m = 0.3;  ///< standard deviation of the position on each axis; never beyond four of them
  double rotation_deg = 12.0;  ///< and of the rotation about each
  double frequency_hz = 0.5;   ///< highest of the smooth motion
};

/// Names motion.handheld.*.
void Register(Parameters& parameters, HandheldOptions& options);

/// Starts from rest at the identity; goes on after duration_s.
CameraMotion MakeHandheldMotion(const HandheldOptions& options, std::uint64_t seed);

struct SliderOptions {
  double duration_s = 3.0;
  double length_m = 0.6;  ///< along the camera's x axis, at constant speed after a start of 0.1 s
};

/// Names motion.slider.*.
void Register(Parameters& parameters, SliderOptions& options);

/// Starts from rest at the identity; goes on after duration_s.
CameraMotion MakeSliderMotion(const SliderOptions& options);

/// Smooth motion through the poses of a trajectory (cubic in position and rotation, continuous velocity), time counted
/// from its first pose, world moved so that the first pose is the identity. Error (kInput) if there are fewer than two
/// poses or they are not in order of time; the motion throws Error (kNothingToDo) at times outside the trajectory.
CameraMotion MakeMotionThrough(const geometry::Trajectory& trajectory);

/// The poses at 0, 1 / rate_hz, ... up to `duration`, stamped from `epoch` on.
geometry::Trajectory TrueTrajectory(const CameraMotion& motion, TimeNs duration, double rate_hz, TimeNs epoch);

}  // namespace evo::simulation
