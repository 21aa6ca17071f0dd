#include "evo/report/evaluation_tables.hpp"
#include "report/tables/metric_row.hpp"
#include "report/tables/segment_rows.hpp"

namespace evo::report {

TableRow MetricRow(const MetricKey& key, const evaluation::Statistics& statistics) {
  return {{"sequence", std::string(key.sequence)},
          {"alignment", std::string(key.alignment)},
          {"metric", std::string(key.metric)},
          {"quantity", std::string(key.quantity)},
          {"unit", std::string(key.unit)},
          {"delta", key.delta},
          {"delta_unit", std::string(key.delta_unit)},
          {"pairs", std::string(key.pairs)},
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
  std::vector<TableRow> rows;
  for (const auto& result : evaluation.alignments) {
    const auto append = [&](MetricKey key, const evaluation::RelationStatistics& entry) {
      key.sequence = sequence;
      key.alignment = result.alignment.name;
      key.quantity = evaluation::QuantityName(entry.relation);
      key.unit = evaluation::UnitName(entry.relation);
      rows.push_back(MetricRow(key, entry.statistics));
    };
    for (const auto& entry : result.ape) append({.metric = "ape"}, entry);
    for (const auto& rpe : result.rpe) {
      for (const auto& entry : rpe.relations) {
        append({.metric = "rpe",
                .delta = rpe.delta.value,
                .delta_unit = evaluation::UnitName(rpe.delta.unit),
                .pairs = rpe.pairs},
               entry);
      }
    }
  }
  const auto segments = SegmentMetricRows(sequence, evaluation);
  rows.insert(rows.end(), segments.begin(), segments.end());
  return rows;
}

}  // namespace evo::report
