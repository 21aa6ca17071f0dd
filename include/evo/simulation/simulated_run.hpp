#pragma once

#include <memory>

#include "evo/core/time.hpp"
#include "evo/geometry/camera.hpp"
#include "evo/geometry/trajectory.hpp"
#include "evo/simulation/pose_function.hpp"
#include "evo/simulation/scene_options.hpp"

namespace evo::simulation {

struct Scene;

/// A world, a camera and the camera's motion. Times count from the start of the run.
struct SimulatedRun {
  std::shared_ptr<const Scene> scene;
  geometry::Camera camera;
  PoseFunction T_world_cam;
  TimeNs duration = 0;
  TimeNs before = 0;  ///< `T_world_cam` is defined from -before on
};

/// Throws Error: kInput for a calibration or motion file that cannot be read, kConfiguration for options that do not
/// fit together.
SimulatedRun MakeRun(const SceneOptions& options);

/// `duration` of `run` from `from` on as a run of its own: the same world and poses, with time counted from `from`.
/// Throws Error(kUsage) if [from, from + duration] is empty or leaves `run`.
SimulatedRun PartOf(const SimulatedRun& run, TimeNs from, TimeNs duration);

/// The poses at 0, 1 / hz, 2 / hz, ... and at `duration`.
geometry::Trajectory SamplePoses(const PoseFunction& T_world_cam, TimeNs duration, double hz);

}  // namespace evo::simulation
