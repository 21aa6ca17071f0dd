#include "evo/report/evaluation_tables.hpp"

#include <array>
#include <limits>

#include "evo/core/output_file.hpp"

namespace evo::report {

namespace {

constexpr double kUndetermined = std::numeric_limits<double>::quiet_NaN();

using Component = std::pair<const char*, const evaluation::ErrorSummary&>;

std::array<Component, 4> Components(const evaluation::AlignedEvaluation& result) {
  return {{{"longitudinal", result.longitudinal},
           {"lateral", result.lateral},
           {"vertical", result.vertical},
           {"planar", result.planar}}};
}

/// The planar error is never negative, so the name of its mean has no "abs".
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
  row->emplace_back("rebootstraps", rebootstraps ? TableCell(*rebootstraps) : TableCell(kUndetermined));
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
  add("_percent", evaluation.path_m > 0.0 ? 100.0 / evaluation.path_m : kUndetermined);
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
    const auto& nees = evaluation.nees;
    rows.back().emplace_back("nees_translation", nees ? nees->translation.mean : kUndetermined);
    rows.back().emplace_back("nees_rotation", nees ? nees->rotation.mean : kUndetermined);
    rows.back().emplace_back("nees_pose", nees ? nees->pose.mean : kUndetermined);
  }
  return rows;
}

void WriteErrors(const std::filesystem::path& path, const std::vector<evaluation::PoseError>& errors, bool has_stamps) {
  OutputFile file(path);
  auto& out = file.stream();
  out << (has_stamps ? "stamp" : "frame")
      << ",distance,longitudinal,lateral,vertical,planar,translation,rotation_deg\n";
  for (const auto& error : errors) {
    const auto& position = error.position;
    out << (has_stamps ? FormatTime(error.stamp) : std::to_string(error.stamp / kNsPerSecond));
    for (const double value : {error.distance, position.longitudinal, position.lateral, position.vertical,
                               position.planar, error.translation, error.rotation_deg}) {
      out << ',' << FormatFixed(value);
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
      << "frame_interval,s,,," << FormatFixed(statistics.frame_interval_s) << '\n'
      << "tracks,count,,," << statistics.tracks << '\n'
      << "tracks_too_short,count,,," << statistics.tracks_too_short << '\n'
      << "tracks_cut_short,count,,," << statistics.tracks_censored << '\n';
  const auto write_summary = [&](const evaluation::LifetimeSummary& summary, const char* unit) {
    out << "mean," << unit << ",,," << FormatFixed(summary.mean) << '\n'
        << "standard_deviation," << unit << ",,," << FormatFixed(summary.standard_deviation) << '\n'
        << "median," << unit << ",,," << FormatFixed(summary.median) << '\n'
        << "max," << unit << ",,," << FormatFixed(summary.max) << '\n';
  };
  write_summary(statistics.in_frames, "frames");
  write_summary(statistics.in_seconds, "s");
  for (const auto& bin : statistics.histogram) {
    out << "histogram,tracks," << bin.low << ',' << bin.high << ',' << bin.tracks << '\n';
  }
  for (const auto& bin : statistics.histogram_seconds) {
    out << "histogram_s,tracks," << FormatFixed(bin.low) << ',' << FormatFixed(bin.high) << ',' << bin.tracks << '\n';
  }
  file.Commit();
}

}  // namespace evo::report
