#pragma once

namespace evo {

/// Weights of iteratively reweighted least squares (P. J. Huber: Robust Statistics, 1981). The argument is the error over
/// the scale, or its square, so it has no unit.

/// Of the efficiency of least squares under Gaussian noise each loss keeps 95 % at this width, in standard deviations.
inline constexpr double kHuberWidth = 1.345;
inline constexpr double kTukeyWidth = 4.685;
inline constexpr double kCauchyWidth = 2.385;

/// Weight of Cauchy's loss, log(1 + u^2) / 2, at u^2 = `squared`.
inline double CauchyWeight(double squared) { return 1.0 / (1.0 + squared); }

/// Weight of Huber's loss for an error `u` >= 0 in units of the width.
inline double HuberWeight(double u) { return u <= 1.0 ? 1.0 : 1.0 / u; }

/// Weight of Tukey's biweight loss for an error `u` in units of the width: 0 from |u| = 1 on.
inline double TukeyWeight(double u) {
  const double rest = 1.0 - u * u;
  return rest > 0.0 ? rest * rest : 0.0;
}

}  // namespace evo
