#pragma once

#include <algorithm>

namespace evo::simulation {

/// Rises from 0 at u <= 0 to 1 at u >= 1 with continuous first and second derivatives (K. Perlin, Improving Noise,
/// SIGGRAPH 2002).
inline double SmootherStep(double u) {
  u = std::clamp(u, 0.0, 1.0);
  return u * u * u * (10.0 + u * (6.0 * u - 15.0));
}

}  // namespace evo::simulation
