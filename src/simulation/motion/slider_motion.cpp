#include "simulation/motion/slider_motion.hpp"

#include <algorithm>

#include "evo/core/error.hpp"

namespace evo::simulation {

namespace {

constexpr double kAccelerationTime = 0.1;  // s; a start at full speed would be a jump of the velocity

}  // namespace

PoseFunction MakeSliderMotion(const SliderOptions& options) {
  if (!(options.duration_s > kAccelerationTime)) {
    throw Error(ErrorKind::kConfiguration, "motion.slider.duration_s must be above 0.1");
  }
  const double speed = options.length_m / (options.duration_s - 0.5 * kAccelerationTime);
  return [speed](TimeNs t_ns) -> geometry::SE3 {
    const double t = ToSeconds(t_ns);
    // The speed rises as 3 u^2 - 2 u^3; this is its integral.
    const double u = std::clamp(t / kAccelerationTime, 0.0, 1.0);
    const double x = kAccelerationTime * (u * u * u - 0.5 * u * u * u * u) + std::max(0.0, t - kAccelerationTime);
    return {Eigen::Quaterniond::Identity(), {speed * x, 0.0, 0.0}};
  };
}

}  // namespace evo::simulation
