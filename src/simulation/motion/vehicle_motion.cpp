#include "simulation/motion/vehicle_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "evo/core/error.hpp"
#include "simulation/motion/bumps.hpp"
#include "simulation/motion/sinusoids.hpp"
#include "simulation/motion/speed_profile.hpp"
#include "simulation/smoother_step.hpp"

namespace evo::simulation {

namespace {

constexpr std::uint64_t kStream = 0x636172;  // "car"
constexpr double kRadPerDegree = std::numbers::pi / 180.0;

// Vibration grows with the speed; a standing car's comes from its engine.
constexpr double kIdleVibration = 0.1;       // amplitude at rest over that at full speed
constexpr double kFullVibrationSpeed = 5.0;  // m/s, of the full amplitude
constexpr double kVibrationOnset = 0.2;      // s, so that the run starts at the identity
constexpr double kFullBumpSpeed = 2.0;       // m/s, from which on a bump has its full amplitude

struct Bump {
  double time = 0.0;       ///< s
  double amplitude = 0.0;  ///< factor of BumpResponse: its peak becomes 1 at full speed
  double roll_side = 1.0;  ///< 1 or -1
};

std::vector<double> BumpTimes(const VehicleOptions& options) {
  const auto times = ParseBumpTimes(options.bumps_at_s, options.duration_s);
  if (!times) {
    throw Error(ErrorKind::kConfiguration,
                fmt::format("motion.vehicle.bumps_at_s is '{}' but must be times in s (\"52,60\") or \"every 5\"",
                            options.bumps_at_s));
  }
  return *times;
}

/// The pose as a composition of the road, the bumps, the vibration and the mount.
class Vehicle {
 public:
  Vehicle(const ReferenceLine& road, const VehicleOptions& options, std::uint64_t seed)
      : road_(road), options_(options), speeds_(road, options) {
    Random random(seed, kStream);
    const double deviation = options.vibration_deg * kRadPerDegree;
    for (int axis = 0; axis < 3; ++axis) {
      vibration_.emplace_back(0.6 * options.vibration_hz, 1.4 * options.vibration_hz, deviation, &random);
    }
    const double peak = BumpResponsePeak();
    for (const double time : BumpTimes(options)) {
      const double side = random.Chance(0.5) ? 1.0 : -1.0;
      bumps_.push_back({time, std::min(1.0, speeds_.SpeedAt(time) / kFullBumpSpeed) / peak, side});
    }
    R_vehicle_cam_ = MountRotation(options);
  }

  double DistanceAt(double t) const { return speeds_.DistanceAt(t); }

  geometry::SE3 PoseAt(double t) const {
    const ReferenceLine::Point point = road_.PointAt(DistanceAt(t));
    const Eigen::Quaterniond R_world_road =
        geometry::so3::Exp({0.0, point.heading, 0.0}) * geometry::so3::Exp({point.pitch, 0.0, 0.0});
    Eigen::Vector3d rotation = VibrationAt(t);
    double heave = 0.0;
    auto bump = std::ranges::lower_bound(bumps_, t - kBumpDuration, {}, &Bump::time);
    for (; bump != bumps_.end() && bump->time < t; ++bump) {
      const double x = bump->amplitude * BumpResponse(t - bump->time);
      rotation.x() += x * options_.bump_pitch_deg * kRadPerDegree;
      rotation.z() += x * options_.bump_roll_deg * kRadPerDegree * bump->roll_side;
      heave += x * options_.bump_heave_m;
    }
    const double height = options_.camera_height_m;
    return {
        R_world_road * geometry::so3::Exp(rotation) * R_vehicle_cam_,
        point.position + Eigen::Vector3d(0.0, height, 0.0) + R_world_road * Eigen::Vector3d(0.0, -height - heave, 0.0)};
  }

 private:
  Eigen::Vector3d VibrationAt(double t) const {
    const double speed_ratio = SmootherStep(speeds_.SpeedAt(t) / kFullVibrationSpeed);
    const double amplitude =
        (kIdleVibration + (1.0 - kIdleVibration) * speed_ratio) * SmootherStep(t / kVibrationOnset);
    return amplitude * Eigen::Vector3d(vibration_[0].Evaluate(t), vibration_[1].Evaluate(t), vibration_[2].Evaluate(t));
  }

  ReferenceLine road_;
  VehicleOptions options_;
  SpeedProfile speeds_;
  std::vector<Sinusoids> vibration_;  ///< rotation vector, rad
  std::vector<Bump> bumps_;
  Eigen::Quaterniond R_vehicle_cam_;
};

void CheckOptions(const VehicleOptions& options) {
  // Register checks what users set; this guards options set in code.
  const bool valid = options.duration_s > 0.0 && options.duration_s <= 36'000.0 && options.speed_m_s > 0.0 &&
                     options.acceleration_m_s2 > 0.0 && options.stand_s >= 0.0 && options.turn_speed_m_s > 0.0;
  if (!valid) {
    throw Error(ErrorKind::kConfiguration,
                "motion.vehicle: duration_s (at most 36000), speed_m_s, acceleration_m_s2 and turn_speed_m_s must be "
                "above 0, stand_s at least 0");
  }
}

}  // namespace

Eigen::Quaterniond MountRotation(const VehicleOptions& options) {
  return geometry::so3::Exp({0.0, options.camera_yaw_deg * kRadPerDegree, 0.0}) *
         geometry::so3::Exp({-options.camera_pitch_deg * kRadPerDegree, 0.0, 0.0}) *
         geometry::so3::Exp({0.0, 0.0, options.camera_roll_deg * kRadPerDegree});
}

VehicleMotion MakeVehicleMotion(const ReferenceLine& road, const VehicleOptions& options, std::uint64_t seed) {
  CheckOptions(options);
  const auto vehicle = std::make_shared<const Vehicle>(road, options, seed);
  return {[vehicle](TimeNs t) { return vehicle->PoseAt(ToSeconds(t)); },
          [vehicle](TimeNs t) { return vehicle->DistanceAt(ToSeconds(t)); }};
}

}  // namespace evo::simulation
