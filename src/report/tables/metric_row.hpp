#pragma once

#include <limits>
#include <string_view>

#include "evo/evaluation/statistics.hpp"
#include "evo/report/tables.hpp"

namespace evo::report {

/// The columns of metrics.csv that identify its statistics.
struct MetricKey {
  std::string_view sequence = {};
  std::string_view alignment = {};
  std::string_view metric = {};    ///< "ape", "rpe", "kitti", "subtrajectory"
  std::string_view quantity = {};  ///< "translation", "rotation", ...
  std::string_view unit = {};
  double delta = std::numeric_limits<double>::quiet_NaN();  ///< distance between poses; NaN is an empty cell
  std::string_view delta_unit = {};
  std::string_view pairs = {};  ///< rule that selected the pairs of poses
};

/// One row of metrics.csv: `sequence,alignment,metric,quantity,unit,delta,delta_unit,pairs,count`, then
/// `rmse,mean,median,std,min,max` in `unit` and `sse` in its square.
TableRow MetricRow(const MetricKey& key, const evaluation::Statistics& statistics);

}  // namespace evo::report
