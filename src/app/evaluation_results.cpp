#include "app/evaluation_results.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "evo/report/figures.hpp"
#include "evo/report/gnuplot.hpp"
#include "evo/report/metric_rows.hpp"
#include "evo/report/tables.hpp"

namespace evo::app {

namespace {

/// What tells the files of an alignment apart: nothing for the first one.
std::string Suffix(std::size_t index, const Alignment& alignment) {
  if (index == 0) return "";
  std::string suffix = "_" + alignment.name;
  std::ranges::replace(suffix, ':', '-');
  return suffix;
}

void WarnOfWhatIsMissing(const Evaluation& evaluation) {
  for (const auto& reason : evaluation.left_out) spdlog::warn("left out of the report: {}", reason);
  if (evaluation.alignments.empty()) return;
  for (const auto& rpe : evaluation.alignments.front().rpe) {
    if (rpe.relations.front().statistics.count > 0) continue;
    spdlog::warn("no relative errors over {} ({} pairs): {}", rpe.delta.name, rpe.pairs,
                 evaluation.has_stamps || rpe.delta.unit != DeltaUnit::kSeconds
                     ? "the way is too short, or the tolerance too small"
                     : "the files have no stamps");
  }
}

}  // namespace

std::vector<std::string> EvaluationResultNames(std::span<const Alignment> alignments) {
  std::vector<std::string> names{"summary.csv", "summary.json", "metrics.csv"};
  for (std::size_t i = 0; i < alignments.size(); ++i) names.push_back("errors" + Suffix(i, alignments[i]) + ".csv");
  return names;
}

void WriteEvaluationResults(const std::filesystem::path& folder, const std::string& sequence,
                            const Evaluation& evaluation, bool with_plots, std::optional<std::int64_t> rebootstraps) {
  WarnOfWhatIsMissing(evaluation);
  if (evaluation.alignments.empty()) return;
  const auto rows = SummaryRows(sequence, evaluation, rebootstraps);
  WriteCsv(folder / "summary.csv", rows);
  WriteJson(folder / "summary.json", rows);
  WriteCsv(folder / "metrics.csv", MetricRows(sequence, evaluation), Digits::kAll);
  Gnuplot gnuplot(folder / "plots");
  for (std::size_t i = 0; i < evaluation.alignments.size(); ++i) {
    const auto& result = evaluation.alignments[i];
    const std::string suffix = Suffix(i, result.alignment);
    WriteErrors(folder / ("errors" + suffix + ".csv"), result.errors, evaluation.has_stamps);
    if (!with_plots) continue;
    const std::string trajectory = "trajectory" + suffix;
    const std::string errors = "errors" + suffix;
    gnuplot.Draw(trajectory, TrajectoryFigure(trajectory, evaluation, result));
    gnuplot.Draw(errors, ErrorFigure(errors, evaluation, result));
  }
}

std::string SequenceName(const std::filesystem::path& ground_truth) {
  std::string name = ground_truth.stem().string();
  if (name == "groundtruth") return std::filesystem::absolute(ground_truth).parent_path().filename().string();
  for (const std::string ending : {"_gt", "_groundtruth"}) {
    if (name.ends_with(ending) && name.size() > ending.size()) name.resize(name.size() - ending.size());
  }
  return name;
}

}  // namespace evo::app
