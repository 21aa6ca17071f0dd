#pragma once

#include <cstdint>

namespace evo {

/// Pseudo-random numbers that depend only on seed, stream and how many were drawn: give every pixel or object a stream
/// of its own and the result is the same for any number of threads and on any platform (SplitMix64: G. Steele et al.,
/// Fast Splittable Pseudorandom Number Generators, OOPSLA 2014).
class Random {
 public:
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0);

  std::uint64_t Bits();
  /// In [0, 1).
  double Uniform();
  double Uniform(double low, double high) { return low + (high - low) * Uniform(); }
  /// In [0, count); count > 0.
  int Index(int count) { return static_cast<int>(Uniform() * count); }
  bool Chance(double probability) { return Uniform() < probability; }
  /// Mean 0, standard deviation 1 (Box and Muller).
  double Normal();
  /// Mean 1.
  double Exponential();

 private:
  std::uint64_t state_;
};

}  // namespace evo
