#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace evo {

/// Times the median norm of 2-d Gaussian errors it is the standard deviation of a coordinate: a unit one has 1.1774.
inline constexpr double kMedianNormToSigma = 0.8493;

/// The upper one of the two middle values of an even number; 0 for none.
inline double Median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace evo
