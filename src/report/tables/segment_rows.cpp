#include "report/tables/segment_rows.hpp"

#include "report/tables/metric_row.hpp"

namespace evo::report {

namespace {

void AppendKitti(std::vector<TableRow>* rows, MetricKey key, const evaluation::KittiSegments& kitti) {
  if (kitti.lengths.empty()) return;
  key.metric = "kitti";
  key.delta_unit = "m";
  const std::string starts = "every " + std::to_string(kitti.step);
  key.pairs = starts;
  const auto append = [&](const char* quantity, const char* unit, const evaluation::Statistics& statistics) {
    key.quantity = quantity;
    key.unit = unit;
    rows->push_back(MetricRow(key, statistics));
  };
  for (const auto& length : kitti.lengths) {
    key.delta = length.length_m;
    append("translation", "%", length.translation_percent);
    append("rotation", "deg/m", length.rotation_deg_per_m);
  }
  key.delta = MetricKey().delta;
  append("translation", "%", kitti.translation_percent);
  append("rotation", "deg/m", kitti.rotation_deg_per_m);
}

void AppendSubTrajectory(std::vector<TableRow>* rows, MetricKey key, const evaluation::SubTrajectoryErrors& errors) {
  key.metric = "subtrajectory";
  key.delta = errors.length_m;
  key.delta_unit = "m";
  key.pairs = "all";
  const auto append = [&](const char* quantity, const char* unit, const evaluation::Statistics& statistics) {
    key.quantity = quantity;
    key.unit = unit;
    rows->push_back(MetricRow(key, statistics));
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
    MetricKey key;
    key.sequence = sequence;
    key.alignment = result.alignment.name;
    AppendKitti(&rows, key, result.segments.kitti);
    for (const auto& errors : result.segments.sub_trajectories) AppendSubTrajectory(&rows, key, errors);
  }
  return rows;
}

}  // namespace evo::report
