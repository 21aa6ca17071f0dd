#pragma once

#include <cmath>

namespace evo::tracking {

/// The uniform cubic B-spline with knots at the integers, centred on 0 (C. de Boor: A Practical Guide to Splines,
/// 1978).
inline double CubicBSpline(double u) {
  const double a = std::abs(u);
  if (a >= 2.0) return 0.0;
  return a >= 1.0 ? (2.0 - a) * (2.0 - a) * (2.0 - a) / 6.0 : 2.0 / 3.0 - a * a * (1.0 - 0.5 * a);
}

/// Its integral from minus infinity to `u`.
inline double CubicBSplineIntegral(double u) {
  if (u > 0.0) return 1.0 - CubicBSplineIntegral(-u);
  if (u <= -2.0) return 0.0;
  const double square = (2.0 + u) * (2.0 + u);
  if (u <= -1.0) return square * square / 24.0;
  return 0.5 + u * (2.0 / 3.0 - u * u * (1.0 / 3.0 + u / 8.0));
}

}  // namespace evo::tracking
