#include "evo/evaluation/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace evo::evaluation {

Statistics ComputeStatistics(std::span<const double> errors) {
  if (errors.empty()) {
    constexpr double kUndetermined = std::numeric_limits<double>::quiet_NaN();
    return {0, kUndetermined, kUndetermined, kUndetermined, kUndetermined, kUndetermined, kUndetermined, kUndetermined};
  }
  const auto n = static_cast<double>(errors.size());
  Statistics statistics;
  statistics.count = static_cast<std::int64_t>(errors.size());
  for (const double error : errors) {
    statistics.mean += error;
    statistics.sse += error * error;
  }
  statistics.mean /= n;
  statistics.rmse = std::sqrt(statistics.sse / n);
  double variance = 0.0;
  for (const double error : errors) variance += (error - statistics.mean) * (error - statistics.mean);
  statistics.standard_deviation = std::sqrt(variance / n);

  std::vector<double> values(errors.begin(), errors.end());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  // An even number has two middle values; the lower one is the largest before `middle`.
  statistics.median = values.size() % 2 ? *middle : 0.5 * (*std::max_element(values.begin(), middle) + *middle);
  const auto [min, max] = std::ranges::minmax(errors);
  statistics.min = min;
  statistics.max = max;
  return statistics;
}

}  // namespace evo::evaluation
