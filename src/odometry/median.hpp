#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace evo {

/// The upper one of the two middle values of an even number; 0 for none.
inline double Median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace evo
