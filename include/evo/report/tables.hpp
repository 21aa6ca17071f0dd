#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "evo/evaluation/evaluation.hpp"
#include "evo/evaluation/lifetime.hpp"

namespace evo::report {

/// NaN is an empty cell in CSV and null in JSON.
using TableCell = std::variant<std::string, std::int64_t, double>;
/// One row of a table: column name and value.
using TableRow = std::vector<std::pair<std::string, TableCell>>;

/// One row for each alignment: lengths in m, angles in degrees, percentages of the true path. Columns keep their names
/// and order from version to version; new ones come last. `rebootstraps`: how often the odometry started anew, if
/// known.
std::vector<TableRow> SummaryRows(const std::string& sequence, const evaluation::Evaluation& evaluation,
                                  std::optional<std::int64_t> rebootstraps = std::nullopt);

enum class Digits {
  kFixed,  ///< nine decimals: columns line up by eye
  kAll,    ///< the shortest text that reads back as the same double: for comparisons with other programs
};

/// A header, then the rows. All writers here throw Error (kOutput) and leave no half-written file.
void WriteCsv(const std::filesystem::path& path, const std::vector<TableRow>& rows, Digits digits = Digits::kFixed);
/// summary.json: an array of objects with the same names and values.
void WriteJson(const std::filesystem::path& path, const std::vector<TableRow>& rows);

/// errors.csv: a row a pose, `stamp` (s, as in the estimate; `frame`, the number of the pose, for files without),
/// `distance`, `longitudinal`, `lateral`, `vertical`, `planar`, `translation` (m, see PoseError and DrivingError for
/// the signs) and `rotation_deg`.
void WriteErrors(const std::filesystem::path& path, const std::vector<evaluation::PoseError>& errors, bool has_stamps);

/// lifetime.csv: columns `quantity,unit,bin_low,bin_high,value`. First the summary, whose bin columns are empty
/// (frames, frame_interval, tracks, tracks_too_short, tracks_cut_short; mean, standard_deviation, median, max in frames
/// and in s), then one row "histogram" a bin: `value` tracks live bin_low frames or more but fewer than bin_high; then
/// the same in seconds, "histogram_s".
void WriteLifetimes(const std::filesystem::path& path, const evaluation::LifetimeStatistics& statistics);

/// The summary for people: a few aligned lines that end with a newline.
std::string FormatSummary(const evaluation::Evaluation& evaluation);
/// One such line; `note` ends its bracket.
std::string FormatLifetimes(const evaluation::LifetimeStatistics& statistics, const std::string& note = "");

}  // namespace evo::report
