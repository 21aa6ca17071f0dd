#include "evo/report/tables.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "evo/core/number.hpp"
#include "evo/core/output_file.hpp"

namespace evo::report {

namespace {

std::string FormatAllDigits(double value) { return std::isfinite(value) ? FormatNumber(value) : ""; }

/// A cell of a CSV file with quotes where needed (RFC 4180).
std::string FormatCell(const TableCell& value, Digits digits) {
  if (const auto* number = std::get_if<double>(&value)) {
    return digits == Digits::kAll ? FormatAllDigits(*number) : FormatFixed(*number);
  }
  if (const auto* count = std::get_if<std::int64_t>(&value)) return std::to_string(*count);
  const auto& text = std::get<std::string>(value);
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

}  // namespace

std::string FormatFixed(double value) {
  if (!std::isfinite(value)) return "";
  const std::string text = fmt::format("{:.9f}", value);
  return text == "-0.000000000" ? text.substr(1) : text;
}

void WriteCsv(const std::filesystem::path& path, const std::vector<TableRow>& rows, Digits digits) {
  OutputFile file(path);
  auto& out = file.stream();
  if (!rows.empty()) {
    for (std::size_t i = 0; i < rows[0].size(); ++i) out << (i ? "," : "") << FormatCell(rows[0][i].first, digits);
    out << '\n';
  }
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) out << (i ? "," : "") << FormatCell(row[i].second, digits);
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
  // Names of sequences come from file names, which may not be UTF-8.
  file.stream() << array.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << '\n';
  file.Commit();
}

}  // namespace evo::report
