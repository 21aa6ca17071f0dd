#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include "evo/core/error.hpp"
#include "evo/simulation/motion.hpp"
#include "simulation/motion/smooth.hpp"
#include "simulation/motion/speed_profile.hpp"

namespace evo::simulation {

namespace {

constexpr std::uint64_t kStream = 0x636172;  // "car"
constexpr double kRadPerDegree = std::numbers::pi / 180.0;

constexpr double kIdle = 0.1;            // share of the vibration that a standing car has
constexpr double kFullVibration = 5.0;   // m/s from which on it has all
constexpr double kVibrationStart = 0.2;  // s in which it sets in, so that the run starts at the identity

// A passenger car's body on its springs.
constexpr double kBumpHz = 1.8;
constexpr double kBumpDamping = 0.35;
constexpr double kBumpRise = 0.15;  // s in which the wheel climbs
constexpr double kBumpEnd = 3.0;    // s after which less than 1e-5 of it is left
constexpr double kFullBump = 2.0;   // m/s from which on a bump has its full size

constexpr double kShortestPeriod = 0.1;  // s between bumps

std::optional<double> ParseSeconds(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  double value = 0.0;
  const auto [last, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc() || last != text.data() + text.size() || !std::isfinite(value) || value < 0.0) return {};
  return value;
}

/// Empty if the text is not one of the forms.
std::optional<std::vector<double>> ParseBumps(std::string_view text, double duration) {
  constexpr std::string_view kEvery = "every ";
  std::vector<double> times;
  if (text.empty()) return times;
  if (text.starts_with(kEvery)) {
    const auto period = ParseSeconds(text.substr(kEvery.size()));
    if (!period || *period < kShortestPeriod) return {};
    for (int i = 1; i * *period <= duration; ++i) times.push_back(i * *period);
    return times;
  }
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t comma = std::min(text.find(',', from), text.size());
    const auto time = ParseSeconds(text.substr(from, comma - from));
    if (!time) return {};
    if (*time <= duration) times.push_back(*time);
    from = comma + 1;
  }
  std::ranges::sort(times);
  return times;
}

/// The response of sprung mass to a short knock, starting smoothly at 0.
double RawBump(double t) {
  constexpr double kOmega = 2.0 * std::numbers::pi * kBumpHz;
  const double damped = kOmega * std::sqrt(1.0 - kBumpDamping * kBumpDamping);
  return SmoothStep(t / kBumpRise) * std::exp(-kBumpDamping * kOmega * t) * std::sin(damped * t);
}

double BumpPeak() {
  double peak = 0.0;
  for (double t = 0.0; t < 0.5 / kBumpHz; t += 1e-4) peak = std::max(peak, RawBump(t));
  return peak;
}

struct Bump {
  double time = 0.0;
  double size = 0.0;
  double roll_side = 1.0;
};

/// Everything that the pose at a time is made of.
class Vehicle {
 public:
  Vehicle(const RoadLine& road, const VehicleOptions& options, std::uint64_t seed)
      : road_(road), options_(options), speeds_(road, options) {
    Random random(seed, kStream);
    const double deviation = options.vibration_deg * kRadPerDegree;
    for (int axis = 0; axis < 3; ++axis) {
      vibration_.emplace_back(0.6 * options.vibration_hz, 1.4 * options.vibration_hz, deviation, &random);
    }
    const double peak = BumpPeak();
    for (const double time : BumpTimes(options)) {
      const double side = random.Chance(0.5) ? 1.0 : -1.0;
      bumps_.push_back({time, std::min(1.0, speeds_.Speed(time) / kFullBump) / peak, side});
    }
    mount_ = geometry::so3::Exp({-options.camera_pitch_deg * kRadPerDegree, 0.0, 0.0});
  }

  double Distance(double t) const { return speeds_.Distance(t); }

  geometry::SE3 Pose(double t) const {
    const RoadLine::Point point = road_.At(Distance(t));
    const Eigen::Quaterniond on_road =
        geometry::so3::Exp({0.0, point.heading, 0.0}) * geometry::so3::Exp({point.pitch, 0.0, 0.0});
    Eigen::Vector3d turn = Vibration(t);
    double heave = 0.0;
    auto bump = std::ranges::lower_bound(bumps_, t - kBumpEnd, {}, &Bump::time);
    for (; bump != bumps_.end() && bump->time < t; ++bump) {
      const double x = bump->size * RawBump(t - bump->time);
      turn.x() += x * options_.bump_pitch_deg * kRadPerDegree;
      turn.z() += x * options_.bump_roll_deg * kRadPerDegree * bump->roll_side;
      heave += x * options_.bump_heave_m;
    }
    const double height = options_.camera_height_m;
    return {on_road * geometry::so3::Exp(turn) * mount_,
            point.position + Eigen::Vector3d(0.0, height, 0.0) + on_road * Eigen::Vector3d(0.0, -height - heave, 0.0)};
  }

 private:
  Eigen::Vector3d Vibration(double t) const {
    const double moving = SmoothStep(speeds_.Speed(t) / kFullVibration);
    const double share = (kIdle + (1.0 - kIdle) * moving) * SmoothStep(t / kVibrationStart);
    return share * Eigen::Vector3d(vibration_[0].At(t), vibration_[1].At(t), vibration_[2].At(t));
  }

  RoadLine road_;
  VehicleOptions options_;
  SpeedProfile speeds_;
  std::vector<Sinusoids> vibration_;
  std::vector<Bump> bumps_;
  Eigen::Quaterniond mount_;
};

void Check(const VehicleOptions& options) {
  // What Register lets through makes sense; this guards options set in code.
  const bool sound = options.duration_s > 0.0 && options.duration_s <= 36'000.0 && options.speed_m_s > 0.0 &&
                     options.acceleration_m_s2 > 0.0 && options.stand_s >= 0.0 && options.turn_speed_m_s > 0.0;
  if (!sound) {
    throw Error(ErrorKind::kConfiguration,
                "motion.vehicle: duration_s (at most 36000), speed_m_s, acceleration_m_s2 and turn_speed_m_s must be "
                "above 0, stand_s not below");
  }
}

}  // namespace

void Register(Parameters& parameters, VehicleOptions& options) {
  const std::string prefix = "motion.vehicle.";
  const auto add = [&](const char* name, double* value, double lowest, double highest, const char* help) {
    parameters.Add(prefix + name, value, lowest, highest, help);
  };
  add("duration_s", &options.duration_s, 0.1, 36'000.0, "length of the run, s");
  add("speed_m_s", &options.speed_m_s, 0.1, 40.0, "cruising speed");
  add("acceleration_m_s2", &options.acceleration_m_s2, 0.1, 8.0, "most of it, speeding up and braking");
  add("stop_every_s", &options.stop_every_s, 0.0, 3600.0, "starts to brake to a stop every so many s; 0: never");
  add("stand_s", &options.stand_s, 0.0, 3600.0, "time that each stop lasts");
  add("start_at_rest_s", &options.start_at_rest_s, 0.0, 3600.0, "stands so long at first; 0: starts at full speed");
  add("turn_speed_m_s", &options.turn_speed_m_s, 0.5, 40.0, "speed in right-angle turns");
  add("camera_height_m", &options.camera_height_m, 0.2, 5.0, "above the road");
  add("camera_pitch_deg", &options.camera_pitch_deg, -45.0, 45.0, "positive: looks down");
  add("vibration_deg", &options.vibration_deg, 0.0, 5.0, "standard deviation of small rotations about each axis");
  add("vibration_hz", &options.vibration_hz, 0.1, 100.0, "their frequency");
  parameters.Add(
      prefix + "bumps_at_s", &options.bumps_at_s,
      [](const std::string& text) { return ParseBumps(text, 0.0).has_value(); },
      "times in s (\"52,60\"), \"every 5\" (0.1 or more) or empty", "bumps of the road; empty: none");
  add("bump_pitch_deg", &options.bump_pitch_deg, 0.0, 20.0, "peak of a bump's pitch");
  add("bump_heave_m", &options.bump_heave_m, 0.0, 0.5, "peak of its rise");
  add("bump_roll_deg", &options.bump_roll_deg, 0.0, 20.0, "peak of its roll, to either side");
}

std::vector<double> BumpTimes(const VehicleOptions& options) {
  const auto times = ParseBumps(options.bumps_at_s, options.duration_s);
  if (!times) {
    throw Error(ErrorKind::kConfiguration, "motion.vehicle.bumps_at_s is '" + options.bumps_at_s +
                                               "' but must be times in s (\"52,60\") or \"every 5\"");
  }
  return *times;
}

VehicleMotion MakeVehicleMotion(const RoadLine& road, const VehicleOptions& options, std::uint64_t seed) {
  Check(options);
  const auto vehicle = std::make_shared<const Vehicle>(road, options, seed);
  return {[vehicle](TimeNs t) { return vehicle->Pose(ToSeconds(t)); },
          [vehicle](TimeNs t) { return vehicle->Distance(ToSeconds(t)); }};
}

}  // namespace evo::simulation
