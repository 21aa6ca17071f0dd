#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace evo::report {

/// NaN is an empty cell in CSV and null in JSON.
using TableCell = std::variant<std::string, std::int64_t, double>;
/// Column names and values of one row.
using TableRow = std::vector<std::pair<std::string, TableCell>>;

enum class Digits {
  kFixed,  ///< nine decimals, so that columns line up
  kAll,    ///< the shortest text that reads back as the same double, for comparisons with other programs
};

/// Nine decimals; "" for NaN and infinity, never "-0".
std::string FormatFixed(double value);

/// Writes a header and the rows. Both writers throw Error (kOutput) and leave no incomplete file.
void WriteCsv(const std::filesystem::path& path, const std::vector<TableRow>& rows, Digits digits = Digits::kFixed);
/// Writes an array of objects with the same names and values.
void WriteJson(const std::filesystem::path& path, const std::vector<TableRow>& rows);

}  // namespace evo::report
