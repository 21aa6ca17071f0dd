#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "evo/core/error.hpp"
#include "evo/simulation/motion.hpp"
#include "simulation/motion/smooth.hpp"

namespace evo::simulation {

namespace {

constexpr std::uint64_t kStream = 0x68616E64;  // "hand"
constexpr double kLowestShare = 0.15;          // of the highest frequency
constexpr double kStartPeriods = 1.0;          // of the highest frequency, until the motion has its full size
constexpr double kSliderStart = 0.1;           // s

}  // namespace

void Register(Parameters& parameters, HandheldOptions& options) {
  const std::string prefix = "motion.handheld.";
  parameters.Add(prefix + "duration_s", &options.duration_s, 0.1, 36'000.0, "length of the run, s");
  parameters.Add(prefix + "translation_m", &options.translation_m, 0.0, 10.0,
                 "standard deviation of the position on each axis");
  parameters.Add(prefix + "rotation_deg", &options.rotation_deg, 0.0, 40.0,
                 "standard deviation of the rotation about each axis");
  parameters.Add(prefix + "frequency_hz", &options.frequency_hz, 0.01, 20.0, "highest frequency of the motion");
}

CameraMotion MakeHandheldMotion(const HandheldOptions& options, std::uint64_t seed) {
  if (!(options.frequency_hz > 0.0)) {
    throw Error(ErrorKind::kConfiguration, "motion.handheld.frequency_hz must be above 0");
  }
  Random random(seed, kStream);
  auto axes = std::make_shared<std::vector<Sinusoids>>();
  for (int axis = 0; axis < 6; ++axis) {
    const double deviation = axis < 3 ? options.translation_m : options.rotation_deg * std::numbers::pi / 180.0;
    axes->emplace_back(kLowestShare * options.frequency_hz, options.frequency_hz, deviation, &random);
  }
  const double start = kStartPeriods / options.frequency_hz;
  return [axes = std::shared_ptr<const std::vector<Sinusoids>>(axes), start](TimeNs t_ns) -> geometry::SE3 {
    const double t = ToSeconds(t_ns);
    const double share = SmoothStep(t / start);
    const auto at = [&](int axis) { return share * (*axes)[axis].At(t); };
    return {geometry::so3::Exp({at(3), at(4), at(5)}), {at(0), at(1), at(2)}};
  };
}

void Register(Parameters& parameters, SliderOptions& options) {
  parameters.Add("motion.slider.duration_s", &options.duration_s, 0.2, 36'000.0, "length of the run, s");
  parameters.Add("motion.slider.length_m", &options.length_m, 0.0, 100.0, "way along the camera's x axis");
}

CameraMotion MakeSliderMotion(const SliderOptions& options) {
  if (!(options.duration_s > kSliderStart)) {
    throw Error(ErrorKind::kConfiguration, "motion.slider.duration_s must be above 0.1");
  }
  const double speed = options.length_m / (options.duration_s - 0.5 * kSliderStart);
  return [speed](TimeNs t_ns) -> geometry::SE3 {
    const double t = ToSeconds(t_ns);
    // The speed rises as 3 u^2 - 2 u^3 over the start; this is its integral.
    const double u = std::clamp(t / kSliderStart, 0.0, 1.0);
    const double x = kSliderStart * (u * u * u - 0.5 * u * u * u * u) + std::max(0.0, t - kSliderStart);
    return {Eigen::Quaterniond::Identity(), {speed * x, 0.0, 0.0}};
  };
}

geometry::Trajectory TrueTrajectory(const CameraMotion& motion, TimeNs duration, double rate_hz, TimeNs epoch) {
  if (!(rate_hz > 0.0)) throw Error(ErrorKind::kConfiguration, "the rate of the true poses must be above 0");
  geometry::Trajectory trajectory;
  for (std::int64_t i = 0;; ++i) {
    const TimeNs t = FromSeconds(static_cast<double>(i) / rate_hz);
    if (t > duration) return trajectory;
    trajectory.push_back({epoch + t, motion(t)});
  }
}

}  // namespace evo::simulation
