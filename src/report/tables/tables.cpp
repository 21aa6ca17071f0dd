#include "evo/report/tables.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "evo/core/format.hpp"
#include "evo/core/output_file.hpp"

namespace evo::report {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Fixed point: a table whose columns line up by eye and that any reader parses; a nanometre is the last digit.
std::string Format(double value) {
  if (!std::isfinite(value)) return "";
  char buffer[400];  // the longest double in fixed point has 309 digits before the point
  std::snprintf(buffer, sizeof buffer, "%.9f", value);
  return std::strcmp(buffer, "-0.000000000") == 0 ? buffer + 1 : buffer;
}

std::string FormatAllDigits(double value) {
  if (!std::isfinite(value)) return "";
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

/// A cell of a CSV file: quoted where it must be (RFC 4180).
std::string Cell(const TableCell& value, Digits digits) {
  if (const auto* number = std::get_if<double>(&value)) {
    return digits == Digits::kAll ? FormatAllDigits(*number) : Format(*number);
  }
  if (const auto* count = std::get_if<std::int64_t>(&value)) return std::to_string(*count);
  const auto& text = std::get<std::string>(value);
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

using Component = std::pair<const char*, const evaluation::ErrorSummary&>;

std::array<Component, 4> Components(const evaluation::AlignedEvaluation& result) {
  return {{{"longitudinal", result.longitudinal},
           {"lateral", result.lateral},
           {"vertical", result.vertical},
           {"planar", result.planar}}};
}

/// A length has no sign, so its mean needs no "abs".
std::string MeanName(const Component& component) {
  const std::string name = component.first;
  return (name == "planar" ? "mean_" : "mean_abs_") + name;
}

void AppendRelative(const evaluation::AlignedEvaluation& result, std::optional<std::int64_t> rebootstraps,
                    TableRow* row) {
  const evaluation::RelativePoseError& rpe = result.rpe.front();
  row->emplace_back("rpe_delta", rpe.delta.name);
  row->emplace_back("rpe_translation_rmse_m",
                    evaluation::Find(rpe.relations, evaluation::PoseRelation::kTranslation).rmse);
  row->emplace_back("rpe_rotation_rmse_deg",
                    evaluation::Find(rpe.relations, evaluation::PoseRelation::kRotationDeg).rmse);
  for (const auto& component : Components(result)) {
    row->emplace_back(MeanName(component) + "_over_distance_percent", 100.0 * component.second.mean_over_distance);
  }
  row->emplace_back("rebootstraps", rebootstraps ? TableCell(*rebootstraps) : TableCell(kNone));
}

TableRow SummaryRow(const std::string& sequence, const evaluation::Evaluation& evaluation,
                    const evaluation::AlignedEvaluation& result) {
  TableRow row{{"sequence", sequence},
               {"alignment", result.alignment.name},
               {"scale", result.similarity.scale},
               {"poses", static_cast<std::int64_t>(result.errors.size())},
               {"coverage", evaluation.coverage},
               {"gaps", evaluation.gaps},
               {"path_m", evaluation.path_m}};
  const auto components = Components(result);
  const auto add = [&](const std::string& unit, double factor) {
    for (const auto& component : components) {
      row.emplace_back(MeanName(component) + unit, factor * component.second.mean_abs);
    }
    for (const auto& [name, summary] : components) {
      row.emplace_back(std::string("rmse_") + name + unit, factor * summary.rmse);
    }
    for (const auto& [name, summary] : components) {
      row.emplace_back(std::string("max_") + name + unit, factor * summary.max_abs);
    }
    for (const auto& [name, summary] : components) {
      row.emplace_back(std::string("final_") + name + unit, factor * summary.final);
    }
  };
  add("_m", 1.0);
  add("_percent", evaluation.path_m > 0.0 ? 100.0 / evaluation.path_m : kNone);
  const auto& ape = result.Ape(evaluation::PoseRelation::kTranslation);
  const auto& rotation = result.Ape(evaluation::PoseRelation::kRotationDeg);
  for (const auto& [name, value] : {std::pair{"ape_rmse_m", ape.rmse},
                                    {"ape_mean_m", ape.mean},
                                    {"ape_median_m", ape.median},
                                    {"ape_std_m", ape.standard_deviation},
                                    {"ape_min_m", ape.min},
                                    {"ape_max_m", ape.max},
                                    {"ape_sse_m2", ape.sse},
                                    {"ape_rotation_rmse_deg", rotation.rmse},
                                    {"ape_rotation_mean_deg", rotation.mean},
                                    {"ape_rotation_max_deg", rotation.max}}) {
    row.emplace_back(name, value);
  }
  return row;
}

/// One line of the terminal's table, every cell as wide as `width` allows.
void AppendLine(std::string* table, const std::vector<std::string>& cells) {
  for (std::size_t i = 0; i < cells.size(); ++i) {
    char buffer[64];
    std::snprintf(buffer, sizeof buffer, i == 0 ? "%-14s" : "%11s", cells[i].c_str());
    *table += buffer;
  }
  *table += '\n';
}

std::string Short(double value, int decimals) {
  if (std::isnan(value)) return "-";
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.*f", decimals, value);
  return buffer;
}

/// "-y" for the unit vector (0, -1, 0).
std::string AxisName(const Eigen::Vector3d& axis) {
  Eigen::Index largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  return std::string(axis[largest] < 0.0 ? "-" : "") + "xyz"[largest];
}

}  // namespace

std::vector<TableRow> SummaryRows(const std::string& sequence, const evaluation::Evaluation& evaluation,
                                  std::optional<std::int64_t> rebootstraps) {
  std::vector<TableRow> rows;
  for (const auto& result : evaluation.alignments) {
    rows.push_back(SummaryRow(sequence, evaluation, result));
    AppendRelative(result, rebootstraps, &rows.back());
    const auto& kitti = result.segments.kitti;
    rows.back().emplace_back("kitti_translation_percent", kitti.translation_percent.mean);
    rows.back().emplace_back("kitti_rotation_deg_per_m", kitti.rotation_deg_per_m.mean);
    const auto& consistency = evaluation.consistency;
    rows.back().emplace_back("nees_translation", consistency ? consistency->translation.mean : kNone);
    rows.back().emplace_back("nees_rotation", consistency ? consistency->rotation.mean : kNone);
    rows.back().emplace_back("nees_pose", consistency ? consistency->pose.mean : kNone);
  }
  return rows;
}

void WriteCsv(const std::filesystem::path& path, const std::vector<TableRow>& rows, Digits digits) {
  OutputFile file(path);
  auto& out = file.stream();
  if (!rows.empty()) {
    for (std::size_t i = 0; i < rows[0].size(); ++i) out << (i ? "," : "") << Cell(rows[0][i].first, digits);
    out << '\n';
  }
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) out << (i ? "," : "") << Cell(row[i].second, digits);
    out << '\n';
  }
  file.Commit();
}

void WriteJson(const std::filesystem::path& path, const std::vector<TableRow>& rows) {
  auto array = nlohmann::ordered_json::array();
  for (const auto& row : rows) {
    nlohmann::ordered_json object;
    for (const auto& [name, value] : row) std::visit([&, &key = name](const auto& v) { object[key] = v; }, value);
    array.push_back(std::move(object));
  }
  OutputFile file(path);
  // Names come from file names, which need not be UTF-8.
  file.stream() << array.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << '\n';
  file.Commit();
}

void WriteErrors(const std::filesystem::path& path, const std::vector<evaluation::PoseError>& errors, bool has_stamps) {
  OutputFile file(path);
  auto& out = file.stream();
  out << (has_stamps ? "stamp" : "frame")
      << ",distance,longitudinal,lateral,vertical,planar,translation,rotation_deg\n";
  for (const auto& error : errors) {
    const auto& driving = error.driving;
    out << (has_stamps ? FormatTime(error.stamp) : std::to_string(error.stamp / kNsPerSecond));
    for (const double value : {error.distance, driving.longitudinal, driving.lateral, driving.vertical, driving.planar,
                               error.translation, error.rotation_deg}) {
      out << ',' << Format(value);
    }
    out << '\n';
  }
  file.Commit();
}

void WriteLifetimes(const std::filesystem::path& path, const evaluation::LifetimeStatistics& statistics) {
  OutputFile file(path);
  auto& out = file.stream();
  out << "quantity,unit,bin_low,bin_high,value\n"
      << "frames,count,,," << statistics.frames << '\n'
      << "frame_interval,s,,," << Format(statistics.frame_interval_s) << '\n'
      << "tracks,count,,," << statistics.tracks << '\n'
      << "tracks_too_short,count,,," << statistics.tracks_too_short << '\n'
      << "tracks_cut_short,count,,," << statistics.tracks_cut_short << '\n';
  const auto write_moments = [&](const evaluation::LifetimeMoments& moments, const char* unit) {
    out << "mean," << unit << ",,," << Format(moments.mean) << '\n'
        << "standard_deviation," << unit << ",,," << Format(moments.standard_deviation) << '\n'
        << "median," << unit << ",,," << Format(moments.median) << '\n'
        << "max," << unit << ",,," << Format(moments.max) << '\n';
  };
  write_moments(statistics.in_frames, "frames");
  write_moments(statistics.in_seconds, "s");
  for (const auto& bin : statistics.histogram) {
    out << "histogram,tracks," << bin.low << ',' << bin.high << ',' << bin.tracks << '\n';
  }
  for (const auto& bin : statistics.histogram_seconds) {
    out << "histogram_s,tracks," << Format(bin.low) << ',' << Format(bin.high) << ',' << bin.tracks << '\n';
  }
  file.Commit();
}

std::string FormatSummary(const evaluation::Evaluation& evaluation) {
  std::string table;
  table += "path " + Short(evaluation.path_m, 2) + " m, ";
  if (evaluation.has_stamps) {
    table += Short(ToSeconds(evaluation.to - evaluation.from), 2) + " s, coverage " +
             Short(100.0 * evaluation.coverage, 1) + " %, gaps " + std::to_string(evaluation.gaps) + ", ";
  }
  table += "up " + AxisName(evaluation.up) + "\n";
  const std::string& delta = evaluation.alignments.front().rpe.front().delta.name;
  AppendLine(&table, {"alignment", "scale", "poses", "longitud.", "lateral", "planar", "planar", "planar max",
                      "planar end", "APE rmse", "RPE rmse"});
  AppendLine(&table, {"", "", "", "mean m", "mean m", "mean m", "mean %", "m", "m", "m", "m / " + delta});
  const double percent = 100.0 / evaluation.path_m;
  for (const auto& result : evaluation.alignments) {
    AppendLine(
        &table,
        {result.alignment.name, Short(result.similarity.scale, 5), std::to_string(result.errors.size()),
         Short(result.longitudinal.mean_abs, 4), Short(result.lateral.mean_abs, 4), Short(result.planar.mean_abs, 4),
         evaluation.path_m > 0.0 ? Short(percent * result.planar.mean_abs, 4) : "-", Short(result.planar.max_abs, 4),
         Short(result.planar.final, 4), Short(result.Ape(evaluation::PoseRelation::kTranslation).rmse, 4),
         Short(evaluation::Find(result.rpe.front().relations, evaluation::PoseRelation::kTranslation).rmse, 4)});
  }
  if (const auto& consistency = evaluation.consistency) {
    table += "squared errors over their covariances (1: as said): positions " +
             Short(consistency->translation.mean, 2) + ", rotations " + Short(consistency->rotation.mean, 2) +
             ", poses " + Short(consistency->pose.mean, 2) + "\n";
  }
  return table;
}

std::string FormatLifetimes(const evaluation::LifetimeStatistics& statistics, const std::string& note) {
  return evo::Format("lifetime   %.1f +- %.1f frames, %.2f +- %.2f s (%lld tracks", statistics.in_frames.mean,
                     statistics.in_frames.standard_deviation, statistics.in_seconds.mean,
                     statistics.in_seconds.standard_deviation, static_cast<long long>(statistics.tracks)) +
         note + ")\n";
}

}  // namespace evo::report
