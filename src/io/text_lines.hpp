#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "evo/core/error.hpp"

namespace evo::io {

/// The lines of a text file without blank ones and comments (`#`); a line ends with \n or \r\n.
class TextLines {
 public:
  /// Reads the whole file. Throws Error (kInput).
  explicit TextLines(const std::filesystem::path& path);

  /// Returns false at the end of the file. `line` is trimmed and valid as long as this object.
  bool Next(std::string_view* line);
  /// Number of the last line of Next(), from 1.
  std::size_t number() const { return number_; }
  /// The error "<file>:<line>: <what>".
  Error Failure(const std::string& what) const { return Failure(number_, what); }
  Error Failure(std::size_t number, const std::string& what) const;

 private:
  std::string path_;
  std::string text_;
  std::size_t position_ = 0;
  std::size_t number_ = 0;
};

/// Splits a line at runs of blanks and tabs.
std::vector<std::string_view> SplitFields(std::string_view line);

/// Splits a line at each comma and trims the fields.
std::vector<std::string_view> SplitAtCommas(std::string_view line);

/// `text` without blanks, tabs and \r at either end.
std::string_view Trim(std::string_view text);

/// Empty unless the whole text is a finite number.
std::optional<double> ParseFinite(std::string_view text);

/// Empty unless the whole text is an integer.
std::optional<std::int64_t> ParseInteger(std::string_view text);

/// 'text' for messages; unprintable bytes are replaced and long text is cut.
std::string Quote(std::string_view text);

}  // namespace evo::io
