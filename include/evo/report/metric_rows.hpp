#pragma once

#include <string>
#include <vector>

#include "evo/evaluation/evaluation.hpp"
#include "evo/report/tables.hpp"

namespace evo::report {

/// One row of metrics.csv: `sequence,alignment,metric,quantity,unit,delta,delta_unit,pairs,count`, then
/// `rmse,mean,median, std,min,max` in `unit` and `sse` in its square. `delta_unit` and `pairs` may be empty, and a NaN
/// `delta` is.
TableRow MetricRow(const std::string& sequence, const std::string& alignment, const std::string& metric,
                   const std::string& quantity, const std::string& unit, double delta, const std::string& delta_unit,
                   const std::string& pairs, const evaluation::Statistics& statistics);

/// Every error of every alignment: metric "ape" by relation, then "rpe" by delta and relation;
/// at the end those of SegmentMetricRows.
std::vector<TableRow> MetricRows(const std::string& sequence, const evaluation::Evaluation& evaluation);

}  // namespace evo::report
