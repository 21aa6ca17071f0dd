#pragma once

#include <cstdint>

namespace evo {

/// Pseudo-random numbers that depend only on the seed, the stream and the number of draws: with a stream per pixel or
/// object the result is the same for any number of threads and on any platform. SplitMix64 (G. Steele et al.: Fast
/// Splittable Pseudorandom Number Generators, OOPSLA 2014).
class Random {
 public:
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0);

  std::uint64_t Bits();
  /// Uniform in [0, 1).
  double Uniform();
  double Uniform(double low, double high) { return low + (high - low) * Uniform(); }
  /// Uniform in [0, count); count > 0.
  int Index(int count) { return static_cast<int>(Uniform() * count); }
  bool Chance(double probability) { return Uniform() < probability; }
  /// Normal with mean 0 and standard deviation 1 (Box and Muller).
  double Normal();
  /// Exponential with mean 1.
  double Exponential();

 private:
  std::uint64_t state_;
};

}  // namespace evo
