#pragma once

#include <limits>
#include <string>

#include "evo/evaluation/statistics.hpp"
#include "evo/report/tables.hpp"

namespace evo::report {

/// The columns of metrics.csv that say what its statistics are of.
struct MetricKey {
  std::string sequence;
  std::string alignment;
  std::string metric;    ///< "ape", "rpe", "kitti", "subtrajectory"
  std::string quantity;  ///< "translation", "rotation", ...
  std::string unit;
  double delta = std::numeric_limits<double>::quiet_NaN();  ///< distance between poses; NaN is an empty cell
  std::string delta_unit = {};
  std::string pairs = {};  ///< rule that selected the pairs of poses
};

/// One row of metrics.csv: `sequence,alignment,metric,quantity,unit,delta,delta_unit,pairs,count`, then
/// `rmse,mean,median,std,min,max` in `unit` and `sse` in its square.
TableRow MetricRow(const MetricKey& key, const evaluation::Statistics& statistics);

}  // namespace evo::report
