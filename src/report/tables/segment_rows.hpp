#pragma once

#include <string>
#include <vector>

#include "evo/evaluation/evaluation.hpp"
#include "evo/report/tables.hpp"

namespace evo::report {

/// Rows of metrics.csv for errors over stretches of the path, of each alignment and each length: metric "kitti" with
/// the quantities translation (%) and rotation (deg/m), then over all lengths, `delta` being NaN; metric
/// "subtrajectory" with translation (m and %), rotation (deg and deg/m), yaw and gravity (deg). `delta` is the length
/// in m, `pairs` says from which poses segments start. No rows for a length that does not fit into the path.
std::vector<TableRow> SegmentMetricRows(const std::string& sequence, const evaluation::Evaluation& evaluation);

}  // namespace evo::report
