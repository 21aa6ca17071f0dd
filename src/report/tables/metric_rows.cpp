#include "evo/report/metric_rows.hpp"

#include <limits>

#include "report/tables/segment_rows.hpp"

namespace evo::report {

TableRow MetricRow(const std::string& sequence, const std::string& alignment, const std::string& metric,
                   const std::string& quantity, const std::string& unit, double delta, const std::string& delta_unit,
                   const std::string& pairs, const evaluation::Statistics& statistics) {
  return {{"sequence", sequence},
          {"alignment", alignment},
          {"metric", metric},
          {"quantity", quantity},
          {"unit", unit},
          {"delta", delta},
          {"delta_unit", delta_unit},
          {"pairs", pairs},
          {"count", statistics.count},
          {"rmse", statistics.rmse},
          {"mean", statistics.mean},
          {"median", statistics.median},
          {"std", statistics.standard_deviation},
          {"min", statistics.min},
          {"max", statistics.max},
          {"sse", statistics.sse}};
}

std::vector<TableRow> MetricRows(const std::string& sequence, const evaluation::Evaluation& evaluation) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::vector<TableRow> rows;
  for (const auto& result : evaluation.alignments) {
    const std::string& name = result.alignment.name;
    for (const auto& [relation, statistics] : result.ape) {
      rows.push_back(MetricRow(sequence, name, "ape", evaluation::QuantityName(relation),
                               evaluation::UnitName(relation), kNone, "", "", statistics));
    }
    for (const auto& rpe : result.rpe) {
      for (const auto& [relation, statistics] : rpe.relations) {
        rows.push_back(MetricRow(sequence, name, "rpe", evaluation::QuantityName(relation),
                                 evaluation::UnitName(relation), rpe.delta.value, evaluation::UnitName(rpe.delta.unit),
                                 rpe.pairs, statistics));
      }
    }
  }
  const auto segments = SegmentMetricRows(sequence, evaluation);
  rows.insert(rows.end(), segments.begin(), segments.end());
  return rows;
}

}  // namespace evo::report
