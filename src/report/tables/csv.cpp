#include "evo/report/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>

#include "evo/core/error.hpp"
#include "evo/report/tables.hpp"
#include "report/text_file.hpp"

namespace evo::report {

namespace {

/// Parses the text of a CSV file row by row.
class CsvParser {
 public:
  CsvParser(std::string path, std::string_view text) : path_(std::move(path)), text_(text) {}

  bool AtEnd() const { return position_ == text_.size(); }
  std::size_t line() const { return line_; }

  std::vector<std::string> Row() {
    std::vector<std::string> cells;
    do {
      cells.push_back(Peek() == '"' ? Quoted() : Plain());
    } while (Skip(','));
    Skip('\r');
    if (AtEnd()) throw Failure("the last line has no end; is the file cut short?");
    if (!Skip('\n')) throw Failure("a comma or the end of the line must follow a closing quote");
    ++line_;
    return cells;
  }

  Error Failure(const std::string& what) const { return Failure(line_, what); }
  Error Failure(std::size_t line, const std::string& what) const {
    return Error(ErrorKind::kInput, fmt::format("{}:{}: {}", path_, line, what));
  }

 private:
  char Peek() const { return AtEnd() ? '\0' : text_[position_]; }

  bool Skip(char c) {
    if (AtEnd() || Peek() != c) return false;
    ++position_;
    return true;
  }

  std::string Plain() {
    const std::size_t begin = position_;
    position_ = std::min(text_.find_first_of(",\r\n", begin), text_.size());
    const std::string_view cell = text_.substr(begin, position_ - begin);
    if (cell.find('"') != std::string_view::npos) throw Failure("a quote inside a cell that does not begin with one");
    if (cell.find('\0') != std::string_view::npos) throw Failure("is not text");
    return std::string(cell);
  }

  std::string Quoted() {
    const std::size_t begin = line_;
    std::string cell;
    ++position_;
    while (!AtEnd()) {
      const char c = text_[position_++];
      if (c == '"' && !Skip('"')) return cell;
      if (c == '\n') ++line_;
      cell += c;
    }
    throw Failure(begin, "the quote that begins a cell is never closed; is the file cut short?");
  }

  std::string path_;
  std::string_view text_;
  std::size_t position_ = 0;
  std::size_t line_ = 1;
};

}  // namespace

std::optional<std::size_t> CsvTable::Find(const std::string& column) const {
  const auto found = std::ranges::find(columns, column);
  if (found == columns.end()) return std::nullopt;
  return static_cast<std::size_t>(found - columns.begin());
}

CsvTable ReadCsv(const std::filesystem::path& path) {
  const std::string text = ReadTextFile(path);
  CsvParser parser(path.string(), text);
  if (parser.AtEnd()) throw parser.Failure("the file is empty");
  CsvTable table;
  table.columns = parser.Row();
  std::set<std::string> names;
  for (const auto& name : table.columns) {
    if (name.empty() || !names.insert(name).second) {
      throw parser.Failure(1, name.empty() ? "a column has no name" : "two columns have the name " + name);
    }
  }
  while (!parser.AtEnd()) {
    table.lines.push_back(parser.line());
    table.rows.push_back(parser.Row());
    if (table.rows.back().size() != table.columns.size()) {
      throw parser.Failure(table.lines.back(), fmt::format("{} cells under a header of {}", table.rows.back().size(),
                                                           table.columns.size()));
    }
  }
  return table;
}

void WriteCsv(const std::filesystem::path& path, const CsvTable& table) {
  std::vector<TableRow> rows(table.rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t k = 0; k < table.columns.size(); ++k) rows[i].emplace_back(table.columns[k], table.rows[i][k]);
  }
  WriteCsv(path, rows);
}

}  // namespace evo::report
