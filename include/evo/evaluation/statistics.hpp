#pragma once

#include <cstdint>
#include <span>

namespace evo::evaluation {

/// What evo prints for a list of errors; NaN where the list is empty.
struct Statistics {
  std::int64_t count = 0;
  double rmse = 0.0;
  double mean = 0.0;
  double median = 0.0;
  double standard_deviation = 0.0;  ///< of the population (divided by n)
  double min = 0.0;
  double max = 0.0;
  double sse = 0.0;  ///< sum of squared errors
};

Statistics ComputeStatistics(std::span<const double> errors);

}  // namespace evo::evaluation
