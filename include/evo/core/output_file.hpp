#pragma once

#include <filesystem>
#include <fstream>
#include <ostream>

namespace evo {

/// A result file that appears whole or not at all: written beside its final place, moved there by Commit().
/// Every failure (no such folder, no permission, full disk) is an Error of kind kOutput.
class OutputFile {
 public:
  /// Opens a temporary file beside `path`; parent folders are created.
  explicit OutputFile(std::filesystem::path path);
  /// Removes the temporary file unless Commit() succeeded.
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  std::ostream& stream() { return stream_; }
  void Commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
  std::ofstream stream_;
  bool committed_ = false;
};

}  // namespace evo
