#include "evo/report/terminal_summary.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

namespace evo::report {

namespace {

/// One line of the table of alignments.
void AppendLine(std::string* table, const std::vector<std::string>& cells) {
  *table += fmt::format("{:<14}", cells.front());
  for (std::size_t i = 1; i < cells.size(); ++i) *table += fmt::format("{:>11}", cells[i]);
  *table += '\n';
}

std::string Number(double value, int decimals) {
  return std::isnan(value) ? "-" : fmt::format("{:.{}f}", value, decimals);
}

/// "-y" for the unit vector (0, -1, 0).
std::string AxisName(const Eigen::Vector3d& axis) {
  Eigen::Index index = 0;
  axis.cwiseAbs().maxCoeff(&index);
  return std::string(axis[index] < 0.0 ? "-" : "") + "xyz"[index];
}

}  // namespace

std::string FormatSummary(const evaluation::Evaluation& evaluation) {
  std::string table = "path " + Number(evaluation.path_m, 2) + " m, ";
  if (evaluation.has_stamps) {
    table += fmt::format("{} s, coverage {} %, gaps {}, ", Number(ToSeconds(evaluation.to - evaluation.from), 2),
                         Number(100.0 * evaluation.coverage, 1), evaluation.gaps);
  }
  table += "up " + AxisName(evaluation.up) + "\n";
  const std::string& delta = evaluation.alignments.front().rpe.front().delta.name;
  AppendLine(&table, {"alignment", "scale", "poses", "longitud.", "lateral", "planar", "planar", "planar", "planar",
                      "APE", "RPE " + delta});
  AppendLine(&table, {"", "", "", "mean (m)", "mean (m)", "mean (m)", "mean (%)", "max (m)", "final (m)", "RMSE (m)",
                      "RMSE (m)"});
  const double percent = 100.0 / evaluation.path_m;
  for (const auto& result : evaluation.alignments) {
    const auto& rpe = result.rpe.front().relations;
    AppendLine(
        &table,
        {result.alignment.name, Number(result.similarity.scale, 5), std::to_string(result.errors.size()),
         Number(result.longitudinal.mean_abs, 4), Number(result.lateral.mean_abs, 4), Number(result.planar.mean_abs, 4),
         evaluation.path_m > 0.0 ? Number(percent * result.planar.mean_abs, 4) : "-", Number(result.planar.max_abs, 4),
         Number(result.planar.final, 4), Number(result.Ape(evaluation::PoseRelation::kTranslation).rmse, 4),
         Number(evaluation::Find(rpe, evaluation::PoseRelation::kTranslation).rmse, 4)});
  }
  if (const auto& nees = evaluation.nees) {
    table +=
        fmt::format("normalised estimation error squared (NEES, 1 = consistent): position {}, rotation {}, pose {}\n",
                    Number(nees->translation.mean, 2), Number(nees->rotation.mean, 2), Number(nees->pose.mean, 2));
  }
  return table;
}

std::string FormatTrackAccuracy(const evaluation::TrackAccuracy& accuracy) {
  using enum evaluation::TrackStatus;
  std::string text = fmt::format("tracks     {} of {} evaluated, truth: {}", evaluation::Count(accuracy, kEvaluated),
                                 accuracy.tracks.size(), accuracy.truth);
  for (const auto& [status, name] : {std::pair{kTooShort, "too short"},
                                     {kNoTruth, "without truth"},
                                     {kNoDepth, "without depth"},
                                     {kMovingObject, "on moving objects"},
                                     {kNotTriangulated, "not triangulated"}}) {
    const auto count = evaluation::Count(accuracy, status);
    if (count > 0) text += fmt::format("; {} {}", count, name);
  }
  text +=
      "\nthreshold    position error (px)       track error   feature age (s)   outliers    expected age\n"
      "     (px)   median     mean     95 %  median (px)     mean   median        (%)      (s)     (%)\n";
  for (const auto& threshold : accuracy.thresholds) {
    const std::string name =
        std::isfinite(threshold.threshold_px) ? fmt::format("{:g}", threshold.threshold_px) : "none";
    const double normalized = 100.0 * threshold.expected_age_normalized;
    text += fmt::format("{:>9} {:8.3f} {:8.3f} {:8.3f} {:12.3f} {:8.3f} {:8.3f} {:10.2f} {:8.3f} {:>7}\n", name,
                        threshold.error_px.median, threshold.error_px.mean, threshold.error_quantiles_px.p95,
                        threshold.track_error_median_px, threshold.feature_age_s.mean, threshold.feature_age_s.median,
                        100.0 * threshold.outlier_ratio, threshold.expected_age_s,
                        std::isfinite(normalized) ? fmt::format("{:.1f}", normalized) : "-");
  }
  return text;
}

std::string FormatLifetimes(const evaluation::LifetimeStatistics& statistics, const std::string& note) {
  return fmt::format("lifetime   {:.1f} +- {:.1f} frames, {:.2f} +- {:.2f} s ({} tracks{})\n",
                     statistics.in_frames.mean, statistics.in_frames.standard_deviation, statistics.in_seconds.mean,
                     statistics.in_seconds.standard_deviation, statistics.tracks, note);
}

}  // namespace evo::report
