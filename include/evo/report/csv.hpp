#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace evo::report {

/// A CSV table as text.
struct CsvTable {
  std::vector<std::string> columns;            ///< unique and not empty
  std::vector<std::vector<std::string>> rows;  ///< with one cell for each column
  std::vector<std::size_t> lines;              ///< line of the file, from 1, at which each row begins

  /// Index of a column.
  std::optional<std::size_t> Find(const std::string& column) const;
};

/// Reads a CSV file as of RFC 4180: quoted cells may hold commas, line breaks and doubled quotes; lines end with \n or
/// \r\n. A last line without an end is an error, since a truncated file looks like that. Throws Error (kInput) with
/// file and line.
CsvTable ReadCsv(const std::filesystem::path& path);

/// Writes a table with quotes where needed. Throws Error (kOutput) and leaves no incomplete file.
void WriteCsv(const std::filesystem::path& path, const CsvTable& table);

}  // namespace evo::report
