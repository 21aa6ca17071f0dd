#pragma once

#include <filesystem>
#include <fstream>
#include <ostream>
#include <string>

namespace evo {

/// A temporary path beside a result's final one, for libraries that write the file themselves; Commit() moves the
/// finished file into place. Every failure is an Error of kind kOutput.
class PendingPath {
 public:
  /// Creates the parent folders of `path`.
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

/// A result file that appears whole on Commit() or not at all; before, it is a temporary file beside its final place.
/// Every failure (no such folder, no permission, full disk) is an Error of kind kOutput.
class OutputFile {
 public:
  /// Opens a temporary file beside `path`; parent folders are created.
  explicit OutputFile(std::filesystem::path path);

  std::ostream& stream() { return stream_; }
  /// Throws if the disk is full, so that a long run stops at once.
  void Check() const;
  void Commit();

 private:
  PendingPath pending_;
  std::ofstream stream_;  // closed before pending_ removes the file
};

/// Writes a whole result file.
void WriteText(const std::filesystem::path& path, const std::string& text);

}  // namespace evo
