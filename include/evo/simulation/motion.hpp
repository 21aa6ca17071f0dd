#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "evo/core/parameters.hpp"
#include "evo/geometry/trajectory.hpp"
#include "evo/simulation/scene.hpp"

namespace evo {

/// The line that the road follows, seen from above: heading and height over the distance travelled. Continuous in
/// curvature (straight pieces, clothoids, arcs), so that a car can drive it.
class RoadLine {
 public:
  struct Point {
    Eigen::Vector3d position;  ///< on the road's surface, world frame without the camera's height (y down)
    double heading = 0.0;      ///< rad, 0 along +z, positive to the right (+x)
    double pitch = 0.0;        ///< rad, slope of the road, positive uphill
    double curvature = 0.0;    ///< 1/m, positive to the right
  };
  /// "straight", "curved" (gentle bends from the seed), "turns" (right-angle turns at crossings); hills of +-`slope`.
  RoadLine(const std::string& shape, double length_m, double slope, std::uint64_t seed);
  double length() const;
  Point At(double distance_m) const;
  /// Distances at which a crossing lies (middle of it).
  const std::vector<double>& crossings() const;
};

struct VehicleOptions {
  double duration_s = 60.0;
  double speed_m_s = 7.5;  ///< cruising
  double acceleration_m_s2 = 1.5;
  double stop_every_s = 0.0;  ///< brake to a stop, stand, start again; 0: never
  double stand_s = 2.0;
  double start_at_rest_s = 1.0;  ///< stands so long at the start; 0: starts at cruising speed
  double turn_speed_m_s = 4.0;   ///< slowed down to in right-angle turns
  double camera_height_m = 1.5;
  double camera_pitch_deg = 0.0;  ///< positive: looks down
  double vibration_deg = 0.05;    ///< standard deviation of the engine's and the road's small rotations
  double vibration_hz = 12.0;
  std::string bumps_at_s;       ///< "52,60": times; or "every 5": one every 5 s
  double bump_pitch_deg = 2.0;  ///< size of the damped oscillation
  double bump_heave_m = 0.06;
  double bump_roll_deg = 0.7;
};
void Register(Parameters& parameters, VehicleOptions& options);

/// Distance along the road over time and the pose of the camera.
struct VehicleMotion {
  CameraMotion T_world_cam;
  std::function<double(TimeNs)> distance_m;
};
/// T_world_cam at time 0 is the identity but for vibration; the road lies camera_height_m below.
VehicleMotion MakeVehicleMotion(const RoadLine& road, const VehicleOptions& options, std::uint64_t seed);

struct HandheldOptions {
  double duration_s = 20.0;
  double translation_m = 0.3;  ///< standard deviation of the position on each axis
  double rotation_deg = 12.0;  ///< and of the rotation about each
  double frequency_hz = 0.5;   ///< highest of the smooth motion
};
void Register(Parameters& parameters, HandheldOptions& options);
CameraMotion MakeHandheldMotion(const HandheldOptions& options, std::uint64_t seed);

struct SliderOptions {
  double duration_s = 3.0;
  double length_m = 0.6;  ///< along the camera's x axis, at constant speed after a short start
};
void Register(Parameters& parameters, SliderOptions& options);
CameraMotion MakeSliderMotion(const SliderOptions& options);

/// Smooth motion through the poses of a trajectory (cubic in position and rotation), time counted from its first pose,
/// world moved so that the first pose is the identity. Two poses or more.
CameraMotion MakeMotionThrough(const Trajectory& trajectory);

}  // namespace evo
