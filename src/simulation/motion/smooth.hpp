#pragma once

#include <vector>

#include "evo/core/random.hpp"

namespace evo::simulation {

/// Rises from 0 at u <= 0 to 1 at u >= 1, continuous in its first and second derivative.
double SmoothStep(double u);

/// A sum of sinusoids of random phases: a smooth signal of mean 0 that never repeats within a run.
class Sinusoids {
 public:
  /// Frequencies spread over [lowest_hz, highest_hz]; the sum has this standard deviation.
  Sinusoids(double lowest_hz, double highest_hz, double deviation, Random* random);
  double At(double t_s) const;

 private:
  struct Wave {
    double angular = 0.0;  ///< rad/s
    double phase = 0.0;
  };
  std::vector<Wave> waves_;
  double amplitude_ = 0.0;
};

}  // namespace evo::simulation
