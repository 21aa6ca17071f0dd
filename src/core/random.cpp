#include "evo/core/random.hpp"

#include <cmath>
#include <numbers>

namespace evo {

namespace {

constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15ULL;

std::uint64_t Mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

}  // namespace

Random::Random(std::uint64_t seed, std::uint64_t stream) : state_(Mix(seed + kGolden) ^ Mix(stream * kGolden + 1)) {}

std::uint64_t Random::Bits() { return Mix(state_ += kGolden); }

double Random::Uniform() { return static_cast<double>(Bits() >> 11) * 0x1.0p-53; }

double Random::Normal() {
  const double radius = std::sqrt(2.0 * Exponential());
  return radius * std::cos(2.0 * std::numbers::pi * Uniform());
}

double Random::Exponential() { return -std::log1p(-Uniform()); }

}  // namespace evo
