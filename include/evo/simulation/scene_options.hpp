#pragma once

#include <string>

#include "evo/core/parameters.hpp"
#include "evo/geometry/camera.hpp"
#include "evo/simulation/event_sensor.hpp"
#include "evo/simulation/motion.hpp"
#include "evo/simulation/scene.hpp"
#include "evo/simulation/simulate.hpp"
#include "evo/simulation/world.hpp"

namespace evo::simulation {

/// All that a scene file may say.
struct SceneOptions {
  int seed = 1;
  std::string kind = "street";           ///< street, room, slider: what the world is
  std::string motion = "vehicle";        ///< vehicle, handheld, slider, file: how the camera moves in it
  std::string motion_file;               ///< TUM text, for motion "file"
  std::string calibration = "davis346";  ///< or davis240c, or a file that ReadCalibration reads
  std::string road_shape = "curved";     ///< straight, curved, turns
  double road_length_m = 0.0;            ///< 0: what the motion needs
  double road_slope = 0.0;               ///< steepest of the hills
  StreetOptions street;
  VehicleOptions vehicle;
  HandheldOptions handheld;
  SliderOptions slider;
  SensorOptions sensor;
  SimulationOptions simulation;
};

/// scene.*, road.* and the parameters of all parts.
void Register(Parameters& parameters, SceneOptions& options);

/// A scene that is ready to be simulated.
struct SimulatedRun {
  Scene scene;
  geometry::Camera camera;
  CameraMotion motion;
  TimeNs duration = 0;  ///< of the motion
  TimeNs before = 0;    ///< the motion is known since so long before time 0
};

/// Throws Error: kInput for a calibration or motion file that cannot be read, kConfiguration for options that do not
/// fit together.
SimulatedRun MakeRun(const SceneOptions& options);

/// `duration` of `run` from `from` on as a run of its own: the same world and poses, time counted from there. Throws
/// Error(kUsage) if that is nothing or more than `run` has.
SimulatedRun PartOf(const SimulatedRun& run, TimeNs from, TimeNs duration);

/// `motion` at 0, 1 / hz, 2 / hz, ... and at `duration`.
geometry::Trajectory Sample(const CameraMotion& motion, TimeNs duration, double hz);

}  // namespace evo::simulation
