#include "evo/report/track_tables.hpp"

#include <fmt/format.h>

#include <limits>

#include "evo/report/tables.hpp"

namespace evo::report {

namespace {

constexpr double kUndetermined = std::numeric_limits<double>::quiet_NaN();

/// As in the CSV files, whose names are fixed.
const char* StatusName(evaluation::TrackStatus status) {
  switch (status) {
    case evaluation::TrackStatus::kEvaluated:
      return "judged";
    case evaluation::TrackStatus::kTooShort:
      return "too_short";
    case evaluation::TrackStatus::kNoTruth:
      return "no_truth";
    case evaluation::TrackStatus::kNoDepth:
      return "no_depth";
    case evaluation::TrackStatus::kMovingObject:
      return "moves";
    case evaluation::TrackStatus::kNotTriangulated:
      return "not_triangulated";
  }
  return "";
}

TableRow QualityRow(const std::string& quantity, const std::string& unit, double threshold_px, double age_low_s,
                    double age_high_s, const TableCell& value) {
  return {{"quantity", quantity},     {"unit", unit},  {"threshold_px", threshold_px}, {"age_low_s", age_low_s},
          {"age_high_s", age_high_s}, {"value", value}};
}

void AppendThreshold(const evaluation::ThresholdAccuracy& accuracy, std::vector<TableRow>* rows) {
  const auto& error = accuracy.error_px;
  const auto& age = accuracy.feature_age_s;
  const auto add = [&](const char* quantity, const char* unit, const TableCell& value) {
    rows->push_back(QualityRow(quantity, unit, accuracy.threshold_px, kUndetermined, kUndetermined, value));
  };
  add("compared_positions", "count", error.count);
  add("error_mean", "px", error.mean);
  add("error_median", "px", error.median);
  add("error_rmse", "px", error.rmse);
  add("error_std", "px", error.standard_deviation);
  add("error_max", "px", error.max);
  add("error_p25", "px", accuracy.error_quantiles_px.p25);
  add("error_p75", "px", accuracy.error_quantiles_px.p75);
  add("error_p95", "px", accuracy.error_quantiles_px.p95);
  add("error_p99", "px", accuracy.error_quantiles_px.p99);
  add("track_error_mean", "px", accuracy.track_error_mean_px);
  add("track_error_median", "px", accuracy.track_error_median_px);
  add("exceeding_share", "share", accuracy.exceeding_ratio);
  add("mostly_exceeding_share", "share", accuracy.median_exceeding_ratio);
  add("stray_share", "share", accuracy.false_track_ratio);
  add("outlier_share", "share", accuracy.outlier_ratio);
  add("feature_age_mean", "s", age.mean);
  add("feature_age_median", "s", age.median);
  add("feature_age_std", "s", age.standard_deviation);
  add("expected_feature_age", "s", accuracy.expected_age_s);
  add("expected_feature_age_normalized", "share", accuracy.expected_age_normalized);
}

void AppendErrorOverAge(const evaluation::AgeBin& bin, std::vector<TableRow>* rows) {
  const auto add = [&](const char* quantity, const char* unit, const TableCell& value) {
    rows->push_back(QualityRow(quantity, unit, kUndetermined, bin.low_s, bin.high_s, value));
  };
  add("error_over_age_tracks", "count", bin.tracks);
  add("error_over_age_positions", "count", bin.positions);
  add("error_over_age_p25", "px", bin.p25_px);
  add("error_over_age_median", "px", bin.median_px);
  add("error_over_age_p75", "px", bin.p75_px);
}

TableRow ErrorRow(const evaluation::TrackErrors& track, const std::vector<double>& thresholds_px) {
  const evaluation::Statistics error = evaluation::ComputeStatistics(track.errors_px);
  TableRow row{{"id", track.id},
               {"start", FormatTime(track.start)},
               {"verdict", std::string(StatusName(track.status))},
               {"observations", track.observations},
               {"lifetime_s", track.lifetime_s},
               {"true_lifetime_s", track.true_lifetime_s.value_or(kUndetermined)},
               {"compared", error.count},
               {"mean_error_px", error.mean},
               {"median_error_px", error.median},
               {"rmse_error_px", error.rmse},
               {"max_error_px", error.max},
               {"surface_error_px", track.evaluated() ? track.surface_error_px : kUndetermined}};
  for (std::size_t i = 0; i < thresholds_px.size(); ++i) {
    const double age = track.evaluated() ? track.feature_ages_s[i] : kUndetermined;
    const std::string threshold = fmt::format("{:g}px", thresholds_px[i]);
    row.emplace_back("age_" + threshold + "_s", age);
    row.emplace_back("outlier_" + threshold,
                     track.evaluated() ? TableCell(std::int64_t{age > 0.0 ? 0 : 1}) : TableCell(std::string()));
  }
  return row;
}

}  // namespace

void WriteTrackQuality(const std::filesystem::path& path, const evaluation::TrackAccuracy& accuracy) {
  std::vector<TableRow> rows;
  const auto add = [&](const std::string& quantity, const char* unit, const TableCell& value) {
    rows.push_back(QualityRow(quantity, unit, kUndetermined, kUndetermined, kUndetermined, value));
  };
  add("truth", "name", accuracy.truth);
  add("tracks", "count", static_cast<std::int64_t>(accuracy.tracks.size()));
  for (const auto status : {evaluation::TrackStatus::kEvaluated, evaluation::TrackStatus::kTooShort,
                            evaluation::TrackStatus::kNoTruth, evaluation::TrackStatus::kNoDepth,
                            evaluation::TrackStatus::kMovingObject, evaluation::TrackStatus::kNotTriangulated}) {
    add(std::string("tracks_") + StatusName(status), "count", evaluation::Count(accuracy, status));
  }
  add("expected_feature_age_normalized_1_to_31_px", "share", accuracy.expected_age_normalized);
  for (const auto& threshold : accuracy.thresholds) AppendThreshold(threshold, &rows);
  for (const auto& bin : accuracy.error_over_age) AppendErrorOverAge(bin, &rows);
  WriteCsv(path, rows);
}

void WriteTrackErrors(const std::filesystem::path& path, const evaluation::TrackAccuracy& accuracy) {
  std::vector<TableRow> rows;
  for (const auto& track : accuracy.tracks) rows.push_back(ErrorRow(track, accuracy.thresholds_px));
  WriteCsv(path, rows);
}

}  // namespace evo::report
