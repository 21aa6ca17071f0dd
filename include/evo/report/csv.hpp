#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace evo::report {

/// A table of text with a header.
struct CsvTable {
  std::vector<std::string> columns;            ///< no two the same, none empty
  std::vector<std::vector<std::string>> rows;  ///< each with a cell for each column
  std::vector<std::size_t> lines;              ///< of the file, from 1, on which each row begins

  /// Its place among the columns.
  std::optional<std::size_t> Find(const std::string& column) const;
};

/// Reads a CSV file as RFC 4180 has it: quoted cells may hold commas, line breaks and doubled quotes; lines end with
/// \n or \r\n. A last line without an end is refused, since a file that was cut short looks like that.
/// Throws Error (kInput) with file and line.
CsvTable ReadCsv(const std::filesystem::path& path);

/// Writes it, quoted where it must be, whole or not at all. Throws Error (kOutput).
void WriteCsv(const std::filesystem::path& path, const CsvTable& table);

}  // namespace evo::report
