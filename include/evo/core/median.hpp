#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace evo {

/// Ratio of a coordinate's standard deviation to the median norm of 2-D Gaussian errors: 1 / sqrt(2 ln 2).
inline constexpr double kMedianNormToSigma = 0.8493;

/// The median; the upper one of the two middle values for an even count, 0 for no values.
inline double Median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace evo
