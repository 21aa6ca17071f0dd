#include "simulation/motion/sinusoids.hpp"

#include <cmath>
#include <numbers>

namespace evo::simulation {

namespace {

constexpr int kWaves = 8;  // the peak of the sum is at most sqrt(2 * 8) = 4 standard deviations

}  // namespace

Sinusoids::Sinusoids(double min_hz, double max_hz, double deviation, Random* random)
    : amplitude_(deviation * std::sqrt(2.0 / kWaves)) {
  for (int i = 0; i < kWaves; ++i) {
    const double frequency = min_hz + (max_hz - min_hz) * (i + random->Uniform()) / kWaves;
    waves_.push_back({2.0 * std::numbers::pi * frequency, 2.0 * std::numbers::pi * random->Uniform()});
  }
}

double Sinusoids::Evaluate(double t_s) const {
  double sum = 0.0;
  for (const Wave& wave : waves_) sum += std::sin(wave.angular_frequency * t_s + wave.phase);
  return amplitude_ * sum;
}

}  // namespace evo::simulation
