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

/// The lines of a text file that hold something: blank ones and comments (`#`) are passed over, \r\n is a line end.
class TextLines {
 public:
  /// Reads the whole file. Throws Error (kInput) if that fails.
  explicit TextLines(const std::filesystem::path& path);

  /// False at the end of the file. `line` has no blanks around it and stays valid as long as this object.
  bool Next(std::string_view* line);
  /// Number of the line that Next() gave last, from 1.
  std::size_t number() const { return number_; }
  /// "<file>:<line>: <what>"
  Error Failure(const std::string& what) const { return Failure(number_, what); }
  Error Failure(std::size_t number, const std::string& what) const;

 private:
  std::string path_;
  std::string text_;
  std::size_t position_ = 0;
  std::size_t number_ = 0;
};

/// Cuts a line at blanks and tabs, any number of them.
std::vector<std::string_view> SplitFields(std::string_view line);

/// Cuts a line at each comma; the fields have no blanks around them.
std::vector<std::string_view> SplitAtCommas(std::string_view line);

/// Without blanks and \r at either end.
std::string_view Trim(std::string_view text);

/// Empty unless `text` is entirely a finite number.
std::optional<double> ParseFinite(std::string_view text);

/// Empty unless `text` is entirely an integer.
std::optional<std::int64_t> ParseInteger(std::string_view text);

/// 'text' for messages: bytes that do not print are replaced and long text is cut.
std::string Quote(std::string_view text);

}  // namespace evo::io
