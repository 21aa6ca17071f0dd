#include "io/text_lines.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>

namespace evo::io {

namespace {

constexpr std::size_t kMaxQuoted = 60;  // characters; a message stays one line on a terminal

}  // namespace

TextLines::TextLines(const std::filesystem::path& path) : path_(path.string()) {
  std::ifstream file(path, std::ios::binary);
  text_.assign(std::istreambuf_iterator<char>(file), {});
  if (!file || std::filesystem::is_directory(path)) {
    throw Error(ErrorKind::kInput, path_ + ": cannot be read; check the name and the permissions");
  }
}

bool TextLines::Next(std::string_view* line) {
  const std::string_view text = text_;
  while (position_ < text.size()) {
    const std::size_t end = std::min(text.find('\n', position_), text.size());
    *line = Trim(text.substr(position_, end - position_));
    position_ = end + 1;
    ++number_;
    if (!line->empty() && line->front() != '#') return true;
  }
  return false;
}

Error TextLines::Failure(std::size_t number, const std::string& what) const {
  return {ErrorKind::kInput, path_ + ":" + std::to_string(number) + ": " + what};
}

std::vector<std::string_view> SplitFields(std::string_view line) {
  std::vector<std::string_view> fields;
  for (line = Trim(line); !line.empty(); line = Trim(line)) {
    const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
    fields.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
  return fields;
}

std::vector<std::string_view> SplitAtCommas(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::size_t start = 0; start <= line.size();) {
    const std::size_t comma = std::min(line.find(',', start), line.size());
    fields.push_back(Trim(line.substr(start, comma - start)));
    start = comma + 1;
  }
  return fields;
}

std::string_view Trim(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::optional<double> ParseFinite(std::string_view text) {
  double value = 0.0;
  const auto [last, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc() || last != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<std::int64_t> ParseInteger(std::string_view text) {
  std::int64_t value = 0;
  const auto [last, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc() || last != text.data() + text.size()) return std::nullopt;
  return value;
}

std::string Quote(std::string_view text) {
  std::string quoted = "'";
  for (const char c : text.substr(0, kMaxQuoted)) quoted += c == '\t' || (c >= ' ' && c < '\x7f') ? c : '?';
  return quoted + (text.size() > kMaxQuoted ? "...'" : "'");
}

}  // namespace evo::io
