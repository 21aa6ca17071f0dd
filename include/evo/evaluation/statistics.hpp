#pragma once

#include <cstdint>
#include <span>

namespace evo::evaluation {

/// The statistics that evo prints for a list of errors, in the unit of the errors; NaN for an empty list.
struct Statistics {
  std::int64_t count = 0;
  double rmse = 0.0;
  double mean = 0.0;
  double median = 0.0;
  double standard_deviation = 0.0;  ///< of the population (divided by n)
  double min = 0.0;
  double max = 0.0;
  double sse = 0.0;  ///< sum of squared errors, in the square of the unit
};

Statistics ComputeStatistics(std::span<const double> errors);

}  // namespace evo::evaluation
