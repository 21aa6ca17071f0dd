#pragma once

#include <vector>

#include "evo/core/random.hpp"

namespace evo::simulation {

/// Band-limited noise: a sum of sinusoids of random phases, with mean 0. It does not repeat within a run.
class Sinusoids {
 public:
  /// Frequencies are spread over [min_hz, max_hz]; the sum has the standard deviation `deviation`.
  Sinusoids(double min_hz, double max_hz, double deviation, Random* random);
  double Evaluate(double t_s) const;

 private:
  struct Wave {
    double angular_frequency = 0.0;  ///< rad/s
    double phase = 0.0;              ///< rad
  };
  std::vector<Wave> waves_;
  double amplitude_ = 0.0;
};

}  // namespace evo::simulation
