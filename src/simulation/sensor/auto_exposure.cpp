#include "simulation/sensor/auto_exposure.hpp"

#include <algorithm>
#include <cmath>

namespace evo::simulation {

namespace {

constexpr double kMeanGrey = 100.0;      // target of the exposure: leaves room for highlights twice as bright
constexpr double kClipRatio = 2.0;       // radiance counts up to this multiple of the mean, so that lamps and sky clip
constexpr double kAdaptationRate = 0.1;  // per image: the exposure settles within a second at 20 Hz
constexpr double kMaxGain = 2000.0;      // grey levels per radiance: a longer exposure would blur the drive
constexpr int kIterations = 4;           // of the clipped mean, which has then converged to a grey level

/// The gain that brings the mean of the clipped radiance to kMeanGrey, by fixed-point iteration.
double TargetGain(std::span<const float> radiance) {
  double mean = 0.0;
  for (const float value : radiance) mean += value;
  mean /= static_cast<double>(radiance.size());
  for (int i = 0; i < kIterations; ++i) {
    double clipped = 0.0;
    for (const float value : radiance) clipped += std::min<double>(value, kClipRatio * mean);
    mean = clipped / static_cast<double>(radiance.size());
  }
  return std::min(kMeanGrey / std::max(mean, 1e-9), kMaxGain);
}

}  // namespace

events::GreyImage AutoExposure::Expose(int width, int height, std::span<const float> radiance) {
  const double target = TargetGain(radiance);
  gain_ = gain_ > 0.0 ? gain_ + kAdaptationRate * (target - gain_) : target;
  events::GreyImage image{width, height, std::vector<std::uint8_t>(radiance.size())};
  std::ranges::transform(radiance, image.grey.begin(), [&](float value) {
    return static_cast<std::uint8_t>(std::clamp(std::lround(gain_ * value), 0L, 255L));
  });
  return image;
}

}  // namespace evo::simulation
