#include "app/evaluation/trajectory_results.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "app/run/output_folder.hpp"
#include "evo/core/output_file.hpp"
#include "evo/report/evaluation_tables.hpp"
#include "evo/report/figures.hpp"
#include "evo/report/gnuplot.hpp"
#include "evo/report/latex_tables.hpp"

namespace evo::app {

namespace {

/// Distinguishes the files of the alignments; empty for the first one.
std::string Suffix(std::size_t index, const evaluation::Alignment& alignment) {
  if (index == 0) return "";
  std::string suffix = "_" + alignment.name;
  std::ranges::replace(suffix, ':', '-');
  return suffix;
}

void LogSkipped(const evaluation::Evaluation& evaluation) {
  for (const auto& reason : evaluation.skipped) spdlog::warn("not evaluated: {}", reason);
  if (evaluation.alignments.empty()) return;
  for (const auto& rpe : evaluation.alignments.front().rpe) {
    if (rpe.relations.front().statistics.count > 0) continue;
    spdlog::debug("no relative errors over {} ({} pairs): {}", rpe.delta.name, rpe.pairs,
                  evaluation.has_stamps || rpe.delta.unit != evaluation::DeltaUnit::kSeconds
                      ? "the path is too short or the tolerance too small"
                      : "the files have no stamps");
  }
}

void DrawFigures(const std::filesystem::path& folder, const std::string& suffix,
                 const evaluation::Evaluation& evaluation, const evaluation::AlignedEvaluation& result,
                 const Restarts& known_restarts) {
  const auto restarts = known_restarts.value_or(std::vector<TimeNs>());
  report::Gnuplot gnuplot(folder);
  const auto draw = [&](const std::string& name, const auto& figure) {
    gnuplot.Draw(name + suffix, figure(name + suffix));
  };
  draw("trajectory", [&](const std::string& name) { return report::TrajectoryFigure(name, evaluation, result); });
  draw("axes", [&](const std::string& name) { return report::AxesFigure(name, evaluation, result, restarts); });
  draw("errors", [&](const std::string& name) {
    return report::ErrorFigure(name, evaluation, result, report::ErrorAxis::kTime, restarts);
  });
  draw("errors_distance", [&](const std::string& name) {
    return report::ErrorFigure(name, evaluation, result, report::ErrorAxis::kDistance, restarts);
  });
  draw("scale_drift",
       [&](const std::string& name) { return report::ScaleDriftFigure(name, evaluation, result, restarts); });
}

}  // namespace

std::vector<std::string> EvaluationResultNames(std::span<const evaluation::Alignment> alignments) {
  std::vector<std::string> names{"summary.csv", "summary.json", "metrics.csv", "tables/errors.tex"};
  for (std::size_t i = 0; i < alignments.size(); ++i) names.push_back("errors" + Suffix(i, alignments[i]) + ".csv");
  return names;
}

void RemoveEvaluationResults(const std::filesystem::path& folder) {
  const std::string suffix = R"((_(none|origin|origin-scale|scale|posyaw|se3|sim3|first)(-[0-9.]+s?)?)?)";
  RemoveResults(folder, R"(manifest\.json|summary\.(csv|json)|metrics\.csv|errors)" + suffix + R"(\.csv)");
  RemoveResults(folder / "tables", R"(errors\.tex)");
  RemovePlots(folder, "(trajectory|axes|errors|errors_distance|scale_drift)" + suffix);
}

void WriteEvaluationResults(const std::filesystem::path& folder, const std::string& sequence,
                            const evaluation::Evaluation& evaluation, bool with_plots, const Restarts& restarts) {
  LogSkipped(evaluation);
  if (evaluation.alignments.empty()) return;
  const auto rebootstraps = restarts ? std::optional(static_cast<std::int64_t>(restarts->size())) : std::nullopt;
  const auto rows = report::SummaryRows(sequence, evaluation, rebootstraps);
  report::WriteCsv(folder / "summary.csv", rows);
  report::WriteJson(folder / "summary.json", rows);
  report::WriteCsv(folder / "metrics.csv", report::MetricRows(sequence, evaluation), report::Digits::kAll);
  WriteText(folder / "tables" / "errors.tex", report::ErrorTable(sequence, evaluation));
  for (std::size_t i = 0; i < evaluation.alignments.size(); ++i) {
    const auto& result = evaluation.alignments[i];
    const std::string suffix = Suffix(i, result.alignment);
    report::WriteErrors(folder / ("errors" + suffix + ".csv"), result.errors, evaluation.has_stamps);
    if (with_plots) DrawFigures(folder / "plots", suffix, evaluation, result, restarts);
  }
}

}  // namespace evo::app
