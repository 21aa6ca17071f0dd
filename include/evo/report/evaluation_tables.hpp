#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "evo/evaluation/evaluation.hpp"
#include "evo/evaluation/lifetime.hpp"
#include "evo/report/tables.hpp"

namespace evo::report {

/// summary.csv and summary.json: one row for each alignment; lengths in m, angles in degrees, percentages of the true
/// path. Columns keep their names and order between versions; new ones are appended. `rebootstraps` is the number of
/// reinitialisations of the odometry, if known.
std::vector<TableRow> SummaryRows(const std::string& sequence, const evaluation::Evaluation& evaluation,
                                  std::optional<std::int64_t> rebootstraps = std::nullopt);

/// metrics.csv: every error of every alignment, see MetricRow. Metric "ape" by relation, then "rpe" by delta and
/// relation, then the rows of SegmentMetricRows.
std::vector<TableRow> MetricRows(const std::string& sequence, const evaluation::Evaluation& evaluation);

/// errors.csv: one row a pose with `stamp` (s, as in the estimate; for files without stamps `frame`, the number of the
/// pose), `distance`, `longitudinal`, `lateral`, `vertical`, `planar`, `translation` (m, see PoseError and
/// PositionError) and `rotation_deg`. Throws Error (kOutput).
void WriteErrors(const std::filesystem::path& path, const std::vector<evaluation::PoseError>& errors, bool has_stamps);

/// lifetime.csv with the columns `quantity,unit,bin_low,bin_high,value`. First the summary with empty bin columns
/// (frames, frame_interval, tracks, tracks_too_short, tracks_cut_short; mean, standard_deviation, median, max in frames
/// and in s), then one row "histogram" a bin, the number of tracks with a lifetime in [bin_low, bin_high) frames, then
/// "histogram_s", the same in seconds. Throws Error (kOutput).
void WriteLifetimes(const std::filesystem::path& path, const evaluation::LifetimeStatistics& statistics);

}  // namespace evo::report
