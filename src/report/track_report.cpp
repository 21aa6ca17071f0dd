#include "evo/report/track_report.hpp"

#include <cmath>
#include <limits>

#include "evo/core/format.hpp"
#include "evo/report/tables.hpp"

namespace evo::report {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

using Value = std::variant<std::string, std::int64_t, double>;

const char* VerdictName(evaluation::TrackVerdict verdict) {
  switch (verdict) {
    case evaluation::TrackVerdict::kJudged:
      return "judged";
    case evaluation::TrackVerdict::kTooShort:
      return "too_short";
    case evaluation::TrackVerdict::kNoTruth:
      return "no_truth";
    case evaluation::TrackVerdict::kNoDepth:
      return "no_depth";
    case evaluation::TrackVerdict::kMoves:
      return "moves";
    case evaluation::TrackVerdict::kNotTriangulated:
      return "not_triangulated";
  }
  return "";
}

TableRow QualityRow(const std::string& quantity, const std::string& unit, double threshold_px, double age_low_s,
                    double age_high_s, const Value& value) {
  return {{"quantity", quantity},     {"unit", unit},  {"threshold_px", threshold_px}, {"age_low_s", age_low_s},
          {"age_high_s", age_high_s}, {"value", value}};
}

void AppendThreshold(const evaluation::ThresholdAccuracy& accuracy, std::vector<TableRow>* rows) {
  const auto& error = accuracy.error_px;
  const auto& age = accuracy.feature_age_s;
  const auto add = [&](const char* quantity, const char* unit, const Value& value) {
    rows->push_back(QualityRow(quantity, unit, accuracy.threshold_px, kNone, kNone, value));
  };
  add("compared_positions", "count", error.count);
  add("error_mean", "px", error.mean);
  add("error_median", "px", error.median);
  add("error_rmse", "px", error.rmse);
  add("error_std", "px", error.standard_deviation);
  add("error_max", "px", error.max);
  add("error_p25", "px", accuracy.error_p25_px);
  add("error_p75", "px", accuracy.error_p75_px);
  add("error_p95", "px", accuracy.error_p95_px);
  add("error_p99", "px", accuracy.error_p99_px);
  add("track_error_mean", "px", accuracy.track_error_mean_px);
  add("track_error_median", "px", accuracy.track_error_median_px);
  add("exceeding_share", "share", accuracy.exceeding_share);
  add("mostly_exceeding_share", "share", accuracy.mostly_exceeding_share);
  add("stray_share", "share", accuracy.stray_share);
  add("outlier_share", "share", accuracy.outlier_share);
  add("feature_age_mean", "s", age.mean);
  add("feature_age_median", "s", age.median);
  add("feature_age_std", "s", age.standard_deviation);
  add("expected_feature_age", "s", accuracy.expected_age_s);
  add("expected_feature_age_normalized", "share", accuracy.expected_age_normalized);
}

void AppendErrorOverAge(const evaluation::AgeBin& bin, std::vector<TableRow>* rows) {
  const auto add = [&](const char* quantity, const char* unit, const Value& value) {
    rows->push_back(QualityRow(quantity, unit, kNone, bin.low_s, bin.high_s, value));
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
               {"verdict", std::string(VerdictName(track.verdict))},
               {"observations", track.observations},
               {"lifetime_s", track.lifetime_s},
               {"true_lifetime_s", track.true_lifetime_s.value_or(kNone)},
               {"compared", error.count},
               {"mean_error_px", error.mean},
               {"median_error_px", error.median},
               {"rmse_error_px", error.rmse},
               {"max_error_px", error.max},
               {"surface_error_px", track.judged() ? track.surface_error_px : kNone}};
  for (std::size_t i = 0; i < thresholds_px.size(); ++i) {
    const double age = track.judged() ? track.feature_ages_s[i] : kNone;
    const std::string threshold = Format("%gpx", thresholds_px[i]);
    row.emplace_back("age_" + threshold + "_s", age);
    row.emplace_back("outlier_" + threshold,
                     track.judged() ? Value(std::int64_t{age > 0.0 ? 0 : 1}) : Value(std::string()));
  }
  return row;
}

}  // namespace

void WriteTrackQuality(const std::filesystem::path& path, const evaluation::TrackAccuracy& accuracy) {
  std::vector<TableRow> rows;
  const auto add = [&](const std::string& quantity, const char* unit, const Value& value) {
    rows.push_back(QualityRow(quantity, unit, kNone, kNone, kNone, value));
  };
  add("truth", "name", accuracy.truth);
  add("tracks", "count", static_cast<std::int64_t>(accuracy.tracks.size()));
  for (const auto verdict : {evaluation::TrackVerdict::kJudged, evaluation::TrackVerdict::kTooShort,
                             evaluation::TrackVerdict::kNoTruth, evaluation::TrackVerdict::kNoDepth,
                             evaluation::TrackVerdict::kMoves, evaluation::TrackVerdict::kNotTriangulated}) {
    add(std::string("tracks_") + VerdictName(verdict), "count", evaluation::Count(accuracy, verdict));
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

std::string FormatTrackAccuracy(const evaluation::TrackAccuracy& accuracy) {
  std::string text = Format("tracks     %lld of %zu judged, truth: %s",
                            static_cast<long long>(evaluation::Count(accuracy, evaluation::TrackVerdict::kJudged)),
                            accuracy.tracks.size(), accuracy.truth.c_str());
  for (const auto& [verdict, name] : {std::pair{evaluation::TrackVerdict::kTooShort, "too short"},
                                      {evaluation::TrackVerdict::kNoTruth, "without truth"},
                                      {evaluation::TrackVerdict::kNoDepth, "without depth"},
                                      {evaluation::TrackVerdict::kMoves, "on what moves"},
                                      {evaluation::TrackVerdict::kNotTriangulated, "not triangulated"}}) {
    const auto count = static_cast<long long>(evaluation::Count(accuracy, verdict));
    if (count > 0) text += Format("; %lld %s", count, name);
  }
  text +=
      "\nthreshold   error: median   a track     mean     95 %   age: mean   median  outliers  expected age\n"
      "       px           px        px       px       px          s        s         %         s      %\n";
  for (const auto& threshold : accuracy.thresholds) {
    const auto& age = threshold.feature_age_s;
    const std::string name = std::isfinite(threshold.threshold_px) ? Format("%g", threshold.threshold_px) : "none";
    const double normalized = 100.0 * threshold.expected_age_normalized;
    text += Format("%9s %12.3f %9.3f %8.3f %8.3f %11.3f %8.3f %9.2f %9.3f %6s\n", name.c_str(),
                   threshold.error_px.median, threshold.track_error_median_px, threshold.error_px.mean,
                   threshold.error_p95_px, age.mean, age.median, 100.0 * threshold.outlier_share,
                   threshold.expected_age_s, std::isfinite(normalized) ? Format("%.1f", normalized).c_str() : "-");
  }
  return text;
}

}  // namespace evo::report
