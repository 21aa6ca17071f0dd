#include "evo/report/segment_rows.hpp"

#include <limits>

namespace evo {

namespace {

struct Metric {
  std::string name;
  std::string pairs;
  double length_m;
};

TableRow MetricRow(const TableRow& head, const Metric& metric, const std::string& quantity, const std::string& unit,
                   const Statistics& statistics) {
  TableRow row = head;
  row.insert(row.end(), {{"metric", metric.name},
                         {"quantity", quantity},
                         {"unit", unit},
                         {"delta", metric.length_m},
                         {"delta_unit", "m"},
                         {"pairs", metric.pairs},
                         {"count", statistics.count},
                         {"rmse", statistics.rmse},
                         {"mean", statistics.mean},
                         {"median", statistics.median},
                         {"std", statistics.standard_deviation},
                         {"min", statistics.min},
                         {"max", statistics.max},
                         {"sse", statistics.sse}});
  return row;
}

void AppendKitti(std::vector<TableRow>* rows, const TableRow& head, const KittiSegments& kitti) {
  const auto append = [&](double length_m, const Statistics& translation, const Statistics& rotation) {
    const Metric metric{"kitti", "every " + std::to_string(kitti.step), length_m};
    rows->push_back(MetricRow(head, metric, "translation", "%", translation));
    rows->push_back(MetricRow(head, metric, "rotation", "deg/m", rotation));
  };
  for (const auto& length : kitti.lengths) {
    append(length.length_m, length.translation_percent, length.rotation_deg_per_m);
  }
  if (kitti.lengths.empty()) return;
  append(std::numeric_limits<double>::quiet_NaN(), kitti.translation_percent, kitti.rotation_deg_per_m);
}

void AppendSubTrajectory(std::vector<TableRow>* rows, const TableRow& head, const SubTrajectoryErrors& errors) {
  const Metric metric{"subtrajectory", "all", errors.length_m};
  rows->push_back(MetricRow(head, metric, "translation", "m", errors.translation_m));
  rows->push_back(MetricRow(head, metric, "translation", "%", errors.translation_percent));
  rows->push_back(MetricRow(head, metric, "rotation", "deg", errors.rotation_deg));
  rows->push_back(MetricRow(head, metric, "rotation", "deg/m", errors.rotation_deg_per_m));
  rows->push_back(MetricRow(head, metric, "yaw", "deg", errors.yaw_deg));
  rows->push_back(MetricRow(head, metric, "gravity", "deg", errors.gravity_deg));
}

}  // namespace

std::vector<TableRow> SegmentMetricRows(const std::string& sequence, const Evaluation& evaluation) {
  std::vector<TableRow> rows;
  for (const auto& result : evaluation.alignments) {
    const TableRow head{{"sequence", sequence}, {"alignment", result.alignment.name}};
    AppendKitti(&rows, head, result.segments.kitti);
    for (const auto& errors : result.segments.sub_trajectories) AppendSubTrajectory(&rows, head, errors);
  }
  return rows;
}

}  // namespace evo
