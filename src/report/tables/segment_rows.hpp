#pragma once

#include <string>
#include <vector>

#include "evo/evaluation/evaluation.hpp"
#include "evo/report/tables.hpp"

namespace evo::report {

/// Rows of metrics.csv for errors over segments of the path, for each alignment and length: metric "kitti" with
/// translation (%) and rotation (deg/m), then the same over all lengths with `delta` NaN; metric "subtrajectory" with
/// translation (m and %), rotation (deg and deg/m), yaw and gravity (deg). `delta` is the length (m), `pairs` tells at
/// which poses segments start. Lengths that do not fit into the path have no rows.
std::vector<TableRow> SegmentMetricRows(const std::string& sequence, const evaluation::Evaluation& evaluation);

}  // namespace evo::report
