#include "report/tables/segment_rows.hpp"

#include <limits>

#include "evo/report/metric_rows.hpp"

namespace evo::report {

namespace {

void AppendKitti(std::vector<TableRow>* rows, const std::string& sequence, const std::string& alignment,
                 const evaluation::KittiSegments& kitti) {
  const std::string starts = "every " + std::to_string(kitti.step);
  const auto append = [&](double length_m, const evaluation::Statistics& translation,
                          const evaluation::Statistics& rotation) {
    rows->push_back(MetricRow(sequence, alignment, "kitti", "translation", "%", length_m, "m", starts, translation));
    rows->push_back(MetricRow(sequence, alignment, "kitti", "rotation", "deg/m", length_m, "m", starts, rotation));
  };
  for (const auto& length : kitti.lengths) {
    append(length.length_m, length.translation_percent, length.rotation_deg_per_m);
  }
  if (kitti.lengths.empty()) return;
  append(std::numeric_limits<double>::quiet_NaN(), kitti.translation_percent, kitti.rotation_deg_per_m);
}

void AppendSubTrajectory(std::vector<TableRow>* rows, const std::string& sequence, const std::string& alignment,
                         const evaluation::SubTrajectoryErrors& errors) {
  const auto append = [&](const std::string& quantity, const std::string& unit,
                          const evaluation::Statistics& statistics) {
    rows->push_back(
        MetricRow(sequence, alignment, "subtrajectory", quantity, unit, errors.length_m, "m", "all", statistics));
  };
  append("translation", "m", errors.translation_m);
  append("translation", "%", errors.translation_percent);
  append("rotation", "deg", errors.rotation_deg);
  append("rotation", "deg/m", errors.rotation_deg_per_m);
  append("yaw", "deg", errors.yaw_deg);
  append("gravity", "deg", errors.gravity_deg);
}

}  // namespace

std::vector<TableRow> SegmentMetricRows(const std::string& sequence, const evaluation::Evaluation& evaluation) {
  std::vector<TableRow> rows;
  for (const auto& result : evaluation.alignments) {
    const std::string& name = result.alignment.name;
    AppendKitti(&rows, sequence, name, result.segments.kitti);
    for (const auto& errors : result.segments.sub_trajectories) AppendSubTrajectory(&rows, sequence, name, errors);
  }
  return rows;
}

}  // namespace evo::report
