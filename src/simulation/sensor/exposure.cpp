#include "simulation/sensor/exposure.hpp"

#include <algorithm>
#include <cmath>

namespace evo::simulation {

namespace {

constexpr double kMeanGrey = 100.0;  // that the exposure aims at
constexpr double kBrightest = 2.0;   // radiance counts up to this multiple of the median-like level: lamps and sky clip
constexpr double kAdaptation = 0.1;  // share of the way to the aim in one image
constexpr double kLargestGain = 2000.0;  // the longest exposure that driving allows

/// The gain at which the mean of the clipped image is kMeanGrey, by fixed-point iteration.
double Aim(std::span<const float> radiance) {
  double mean = 0.0;
  for (const float value : radiance) mean += value;
  mean /= static_cast<double>(radiance.size());
  for (int i = 0; i < 4; ++i) {
    double clipped = 0.0;
    for (const float value : radiance) clipped += std::min<double>(value, kBrightest * mean);
    mean = clipped / static_cast<double>(radiance.size());
  }
  return std::min(kMeanGrey / std::max(mean, 1e-9), kLargestGain);
}

}  // namespace

events::GreyImage Exposure::Expose(int width, int height, std::span<const float> radiance) {
  const double aim = Aim(radiance);
  gain_ = gain_ > 0.0 ? gain_ + kAdaptation * (aim - gain_) : aim;
  events::GreyImage image{width, height, std::vector<std::uint8_t>(radiance.size())};
  std::ranges::transform(radiance, image.grey.begin(), [&](float value) {
    return static_cast<std::uint8_t>(std::clamp(std::lround(gain_ * value), 0L, 255L));
  });
  return image;
}

}  // namespace evo::simulation
