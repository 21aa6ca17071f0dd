#include "simulation/motion/handheld_motion.hpp"

#include <memory>
#include <numbers>
#include <vector>

#include "evo/core/error.hpp"
#include "simulation/motion/sinusoids.hpp"
#include "simulation/smoother_step.hpp"

namespace evo::simulation {

namespace {

constexpr std::uint64_t kStream = 0x68616E64;  // "hand"
constexpr double kMinFrequencyRatio = 0.15;    // of the maximum: the mean over a few periods stays near 0
constexpr double kOnsetPeriods = 1.0;          // of the maximum frequency, until the motion has its full amplitude

}  // namespace

PoseFunction MakeHandheldMotion(const HandheldOptions& options, std::uint64_t seed) {
  if (!(options.frequency_hz > 0.0)) {
    throw Error(ErrorKind::kConfiguration, "motion.handheld.frequency_hz must be above 0");
  }
  Random random(seed, kStream);
  auto axes = std::make_shared<std::vector<Sinusoids>>();
  for (int axis = 0; axis < 6; ++axis) {
    const double deviation = axis < 3 ? options.translation_m : options.rotation_deg * std::numbers::pi / 180.0;
    axes->emplace_back(kMinFrequencyRatio * options.frequency_hz, options.frequency_hz, deviation, &random);
  }
  const double onset = kOnsetPeriods / options.frequency_hz;
  return [axes = std::shared_ptr<const std::vector<Sinusoids>>(axes), onset](TimeNs t_ns) -> geometry::SE3 {
    const double t = ToSeconds(t_ns);
    const double amplitude = SmootherStep(t / onset);
    const auto value = [&](int axis) { return amplitude * (*axes)[axis].Evaluate(t); };
    return {geometry::so3::Exp({value(3), value(4), value(5)}), {value(0), value(1), value(2)}};
  };
}

}  // namespace evo::simulation
