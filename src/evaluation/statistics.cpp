#include "evo/evaluation/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace evo {

Statistics ComputeStatistics(std::span<const double> errors) {
  if (errors.empty()) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    return {0, kNone, kNone, kNone, kNone, kNone, kNone, kNone};
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

  std::vector<double> sorted(errors.begin(), errors.end());
  std::ranges::sort(sorted);
  const std::size_t middle = sorted.size() / 2;
  statistics.median = sorted.size() % 2 ? sorted[middle] : 0.5 * (sorted[middle - 1] + sorted[middle]);
  statistics.min = sorted.front();
  statistics.max = sorted.back();
  return statistics;
}

}  // namespace evo
