#pragma once

namespace evo {

// Weights of iteratively reweighted least squares (P. J. Huber: Robust Statistics, 1981). An error and its width have
// the same unit.

/// At these widths, in standard deviations, each loss keeps 95 % of least squares' efficiency under Gaussian noise.
inline constexpr double kHuberWidth = 1.345;
inline constexpr double kTukeyWidth = 4.685;
inline constexpr double kCauchyWidth = 2.385;

/// Weight of Cauchy's loss, w^2 log(1 + e^2 / w^2) / 2, at the squared error over the squared width.
inline double CauchyWeight(double normalized_squared) { return 1.0 / (1.0 + normalized_squared); }

/// Weight of Huber's loss for an `error` >= 0.
inline double HuberWeight(double error, double width) { return error <= width ? 1.0 : width / error; }

/// Weight of Tukey's biweight loss for an `error` >= 0; 0 from the width on.
inline double TukeyWeight(double error, double width) {
  if (error >= width) return 0.0;
  const double inside = 1.0 - error * error / (width * width);
  return inside * inside;
}

}  // namespace evo
