#pragma once

#include <filesystem>
#include <fstream>
#include <ostream>
#include <string>

namespace evo {

/// A name beside a result's final place for libraries that write the file themselves; Commit() moves the finished file
/// into place. Failures are Errors of kind kOutput.
class PendingPath {
 public:
  /// Parent folders of `path` are created.
  explicit PendingPath(std::filesystem::path path);
  /// Removes the temporary file unless Commit() succeeded.
  ~PendingPath();
  PendingPath(const PendingPath&) = delete;
  PendingPath& operator=(const PendingPath&) = delete;

  const std::filesystem::path& path() const { return path_; }
  const std::filesystem::path& temporary() const { return temporary_; }
  void Commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
  bool committed_ = false;
};

/// A result file that appears whole or not at all: written beside its final place, moved there by Commit().
/// Every failure (no such folder, no permission, full disk) is an Error of kind kOutput.
class OutputFile {
 public:
  /// Opens a temporary file beside `path`; parent folders are created.
  explicit OutputFile(std::filesystem::path path);

  std::ostream& stream() { return stream_; }
  /// Throws if what was written so far did not fit: no need to go on then.
  void Check() const;
  void Commit();

 private:
  PendingPath pending_;
  std::ofstream stream_;  // closed before pending_ removes what is left
};

/// A whole result file in one call.
void WriteText(const std::filesystem::path& path, const std::string& text);

}  // namespace evo
