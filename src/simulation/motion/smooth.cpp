#include "simulation/motion/smooth.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace evo::simulation {

namespace {

constexpr int kWaves = 8;  // their peak is at most sqrt(2 * 8) = 4 standard deviations

}  // namespace

double SmoothStep(double u) {
  u = std::clamp(u, 0.0, 1.0);
  return u * u * u * (10.0 + u * (6.0 * u - 15.0));
}

Sinusoids::Sinusoids(double lowest_hz, double highest_hz, double deviation, Random* random)
    : amplitude_(deviation * std::sqrt(2.0 / kWaves)) {
  for (int i = 0; i < kWaves; ++i) {
    const double frequency = lowest_hz + (highest_hz - lowest_hz) * (i + random->Uniform()) / kWaves;
    waves_.push_back({2.0 * std::numbers::pi * frequency, 2.0 * std::numbers::pi * random->Uniform()});
  }
}

double Sinusoids::At(double t_s) const {
  double sum = 0.0;
  for (const Wave& wave : waves_) sum += std::sin(wave.angular * t_s + wave.phase);
  return amplitude_ * sum;
}

}  // namespace evo::simulation
