#include "evo/simulation/simulated_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "evo/core/error.hpp"
#include "evo/geometry/known_cameras.hpp"
#include "evo/io/calibration_io.hpp"
#include "evo/io/trajectory_io.hpp"
#include "simulation/motion/handheld_motion.hpp"
#include "simulation/motion/slider_motion.hpp"
#include "simulation/motion/spline_motion.hpp"
#include "simulation/motion/vehicle_motion.hpp"
#include "simulation/world/world.hpp"

namespace evo::simulation {

namespace {

constexpr double kViewDistance = 250.0;  // m of road past the end: the camera never sees the street end
constexpr double kMaxPixels = 4e6;       // four times the largest event camera, at some 150 bytes a pixel

/// The calibration that camera.* describes.
geometry::Calibration MakeCalibration(const CameraOptions& options) {
  geometry::Calibration calibration;
  calibration.distortion =
      options.distortion == "radtan" ? geometry::Distortion::kRadTan : geometry::Distortion::kEquidistant;
  calibration.width = options.width_px;
  calibration.height = options.height_px;
  calibration.fx = calibration.fy = options.focal_px;
  calibration.cx = 0.5 * (options.width_px - 1) + options.centre_x_px;
  calibration.cy = 0.5 * (options.height_px - 1) + options.centre_y_px;
  calibration.coefficients = {options.k1, options.k2, 0.0, 0.0, 0.0};
  return calibration;
}

geometry::Calibration FindCalibration(const SceneOptions& options) {
  const std::string& name = options.calibration;
  if (name == "camera") return MakeCalibration(options.camera);
  if (name == "davis346") return geometry::MvsecDavis346();
  if (name == "davis240c") return geometry::UzhDavis240c();
  const geometry::Calibration calibration = io::ReadCalibration(name);
  if (static_cast<double>(calibration.width) * calibration.height > kMaxPixels) {
    throw Error(ErrorKind::kInput, fmt::format("{}: a sensor of {} x {} px is too large to be simulated; use at most 4 "
                                               "million pixels",
                                               name, calibration.width, calibration.height));
  }
  return calibration;
}

geometry::Trajectory ReadMotionFile(const SceneOptions& options) {
  if (options.motion_file.empty()) {
    throw Error(ErrorKind::kConfiguration, "motion.kind is 'file' but motion.file names none; give a TUM trajectory");
  }
  geometry::Trajectory trajectory = io::ReadTum(options.motion_file);
  if (trajectory.size() < 2) {
    throw Error(ErrorKind::kInput, options.motion_file + ": a single pose is no motion; give two or more");
  }
  return trajectory;
}

std::uint64_t Seed(const SceneOptions& options) { return static_cast<std::uint64_t>(options.seed); }

/// A motion that does not need a road.
struct FreeMotion {
  PoseFunction T_world_cam;
  TimeNs duration = 0;
  double distance_m = 0.0;  ///< that it may cover along a road
};

FreeMotion MakeFreeMotion(const SceneOptions& options) {
  if (options.motion == "handheld") {
    return {MakeHandheldMotion(options.handheld, Seed(options)), FromSeconds(options.handheld.duration_s), 0.0};
  }
  if (options.motion == "slider") {
    return {MakeSliderMotion(options.slider), FromSeconds(options.slider.duration_s), options.slider.length_m};
  }
  const geometry::Trajectory trajectory = ReadMotionFile(options);
  return {MakeSplineMotion(trajectory), trajectory.back().t - trajectory.front().t, geometry::PathLength(trajectory)};
}

ReferenceLine MakeRoad(const SceneOptions& options, double distance_m) {
  const double length = options.road_length_m > 0.0 ? options.road_length_m : distance_m + kViewDistance;
  return {options.road_shape, length, options.road_slope, Seed(options)};
}

std::optional<Bonnet> MakeBonnet(const VehicleOptions& options, const Lighting& lighting) {
  if (options.bonnet_deg <= 0.0) return {};
  constexpr double kRadPerDegree = std::numbers::pi / 180.0;
  return Bonnet{std::tan(options.bonnet_deg * kRadPerDegree), options.bonnet_reflectivity,
                options.bonnet_paint * lighting.ambient, MountRotation(options)};
}

SimulatedRun MakeDrive(const SceneOptions& options, const geometry::Camera& camera) {
  if (options.kind != "street") {
    throw Error(ErrorKind::kConfiguration,
                fmt::format("motion.kind is 'vehicle' but scene.kind '{}' has no road; choose handheld, slider or file",
                            options.kind));
  }
  const ReferenceLine road = MakeRoad(options, options.vehicle.duration_s * options.vehicle.speed_m_s);
  const VehicleMotion motion = MakeVehicleMotion(road, options.vehicle, Seed(options));
  Scene street = MakeStreet(road, options.street, options.vehicle.camera_height_m, Seed(options), motion.distance_m);
  street.bonnet = MakeBonnet(options.vehicle, street.lighting);
  return {std::make_shared<const Scene>(std::move(street)), camera, motion.T_world_cam,
          FromSeconds(options.vehicle.duration_s)};
}

Scene MakeWorld(const SceneOptions& options, double distance_m) {
  if (options.kind == "room") return MakeRoom(Seed(options));
  if (options.kind == "slider") return MakeSliderScene(Seed(options));
  return MakeStreet(MakeRoad(options, distance_m), options.street, options.vehicle.camera_height_m, Seed(options));
}

}  // namespace

SimulatedRun MakeRun(const SceneOptions& options) {
  const geometry::Camera camera(FindCalibration(options));
  if (options.motion == "vehicle") return MakeDrive(options, camera);
  const FreeMotion motion = MakeFreeMotion(options);
  return {std::make_shared<const Scene>(MakeWorld(options, motion.distance_m)), camera, motion.T_world_cam,
          motion.duration};
}

SimulatedRun PartOf(const SimulatedRun& run, TimeNs from, TimeNs duration) {
  if (from < 0 || duration <= 0 || from + duration > run.duration) {
    throw Error(ErrorKind::kUsage,
                fmt::format("the part lies outside of the motion, which ends after {} s", FormatTime(run.duration)));
  }
  const auto shifted = [from](const PoseFunction& pose) -> PoseFunction {
    return [pose, from](TimeNs t) { return pose(t + from); };
  };
  Scene scene = *run.scene;
  for (Body& body : scene.bodies) body.T_world_body = shifted(body.T_world_body);
  return {std::make_shared<const Scene>(std::move(scene)), run.camera, shifted(run.T_world_cam), duration,
          run.before + from};
}

geometry::Trajectory SamplePoses(const PoseFunction& T_world_cam, TimeNs duration, double hz) {
  geometry::Trajectory trajectory;
  for (std::size_t k = 0;; ++k) {
    const TimeNs t = std::min(FromSeconds(static_cast<double>(k) / hz), duration);
    trajectory.push_back({t, T_world_cam(t)});
    if (t == duration) return trajectory;
  }
}

}  // namespace evo::simulation
