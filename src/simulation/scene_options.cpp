#include "evo/simulation/scene_options.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "evo/core/error.hpp"
#include "evo/geometry/known_cameras.hpp"
#include "evo/io/calibration_io.hpp"
#include "evo/io/trajectory_io.hpp"

namespace evo::simulation {

namespace {

constexpr double kViewAhead = 250.0;  // m of road beyond the end of the drive, so that the street is never seen to end

constexpr double kMostPixels = 4e6;  // four times the largest event camera, at some 150 bytes each

geometry::Calibration FindCalibration(const std::string& name) {
  if (name == "davis346") return geometry::MvsecDavis346();
  if (name == "davis240c") return geometry::UzhDavis240c();
  const geometry::Calibration calibration = io::ReadCalibration(name);
  const std::string size = std::to_string(calibration.width) + " x " + std::to_string(calibration.height) + " px";
  if (static_cast<double>(calibration.width) * calibration.height > kMostPixels) {
    throw Error(ErrorKind::kInput, name + ": a sensor of " + size + " is too large to be simulated; 4 million are not");
  }
  return calibration;
}

Error Misfit(const std::string& what) { return {ErrorKind::kConfiguration, what}; }

geometry::Trajectory ReadMotionFile(const SceneOptions& options) {
  if (options.motion_file.empty()) {
    throw Misfit("motion.kind is 'file' but motion.file names none; give a TUM trajectory");
  }
  geometry::Trajectory trajectory = io::ReadTum(options.motion_file);
  if (trajectory.size() < 2) {
    throw Error(ErrorKind::kInput, options.motion_file + ": a single pose is no motion; give two or more");
  }
  return trajectory;
}

/// The motion and how far it leads along a road.
struct Motion {
  CameraMotion T_world_cam;
  TimeNs duration = 0;
  double distance_m = 0.0;
};

RoadLine MakeRoad(const SceneOptions& options, double distance_m) {
  const double length = options.road_length_m > 0.0 ? options.road_length_m : distance_m + kViewAhead;
  return {options.road_shape, length, options.road_slope, static_cast<std::uint64_t>(options.seed)};
}

/// Every motion but the vehicle's, which needs the road.
Motion MakeFreeMotion(const SceneOptions& options) {
  if (options.motion == "handheld") {
    return {MakeHandheldMotion(options.handheld, static_cast<std::uint64_t>(options.seed)),
            FromSeconds(options.handheld.duration_s), 0.0};
  }
  if (options.motion == "slider") {
    return {MakeSliderMotion(options.slider), FromSeconds(options.slider.duration_s), options.slider.length_m};
  }
  const geometry::Trajectory trajectory = ReadMotionFile(options);
  return {MakeMotionThrough(trajectory), trajectory.back().t - trajectory.front().t, geometry::PathLength(trajectory)};
}

}  // namespace

void Register(Parameters& p, SceneOptions& o) {
  const auto any = [](const std::string&) { return true; };
  p.Add("scene.seed", &o.seed, 0, std::numeric_limits<int>::max(), "of all that is left to chance");
  p.Add("scene.kind", &o.kind, {"street", "room", "slider"}, "the world");
  p.Add("motion.kind", &o.motion, {"vehicle", "handheld", "slider", "file"}, "of the camera");
  p.Add("motion.file", &o.motion_file, any, "path", "trajectory for kind: file (TUM text), gaps are bridged smoothly");
  const auto named = [](const std::string& text) { return !text.empty(); };
  p.Add("scene.calibration", &o.calibration, named, "davis346, davis240c or the path of a calibration",
        "of the camera");
  p.Add("road.shape", &o.road_shape, {"straight", "curved", "turns"}, "turns: at right angles");
  p.Add("road.length_m", &o.road_length_m, 0.0, 1e5, "0: what the motion needs (m)");
  p.Add("road.slope", &o.road_slope, 0.0, 0.3, "steepest of the hills (rise over run)");
  Register(p, o.street);
  Register(p, o.vehicle);
  Register(p, o.handheld);
  Register(p, o.slider);
  Register(p, o.sensor);
  Register(p, o.simulation);
}

SimulatedRun MakeRun(const SceneOptions& options) {
  const auto seed = static_cast<std::uint64_t>(options.seed);
  const geometry::Camera camera(FindCalibration(options.calibration));
  if (options.motion == "vehicle") {
    if (options.kind != "street") {
      throw Misfit("motion.kind is 'vehicle' but scene.kind '" + options.kind +
                   "' has no road; choose handheld, slider or file");
    }
    const RoadLine road = MakeRoad(options, options.vehicle.duration_s * options.vehicle.speed_m_s);
    const TimeNs duration = FromSeconds(options.vehicle.duration_s);
    const VehicleMotion motion = MakeVehicleMotion(road, options.vehicle, seed);
    return {MakeStreet(road, options.street, options.vehicle.camera_height_m, seed, motion.distance_m), camera,
            motion.T_world_cam, duration};
  }
  const Motion motion = MakeFreeMotion(options);
  const auto world = [&] {
    if (options.kind == "room") return MakeRoom(seed);
    if (options.kind == "slider") return MakeSliderScene(seed);
    return MakeStreet(MakeRoad(options, motion.distance_m), options.street, options.vehicle.camera_height_m, seed);
  };
  return {world(), camera, motion.T_world_cam, motion.duration};
}

SimulatedRun PartOf(const SimulatedRun& run, TimeNs from, TimeNs duration) {
  if (from < 0 || duration <= 0 || from + duration > run.duration) {
    throw Error(ErrorKind::kUsage,
                "the part lies outside of the motion, which ends after " + FormatTime(run.duration) + " s");
  }
  const auto later = [from]<class Motion>(const Motion& motion) -> Motion {
    return [motion, from](TimeNs t) { return motion(t + from); };
  };
  SimulatedRun part{run.scene, run.camera, later(run.motion), duration, run.before + from};
  for (Body& body : part.scene.bodies) body.T_world_body = later(body.T_world_body);
  return part;
}

geometry::Trajectory Sample(const CameraMotion& motion, TimeNs duration, double hz) {
  geometry::Trajectory trajectory;
  for (std::size_t k = 0;; ++k) {
    const TimeNs t = std::min(FromSeconds(static_cast<double>(k) / hz), duration);
    trajectory.push_back({t, motion(t)});
    if (t == duration) return trajectory;
  }
}

}  // namespace evo::simulation
