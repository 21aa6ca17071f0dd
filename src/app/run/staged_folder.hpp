#pragma once

#include <filesystem>

namespace evo::app {

/// A temporary folder within the output folder for results that belong together: they are written into path() and
/// appear in `out` on Commit(). Without Commit() nothing is left, also when InterruptGuard ends the process. Every
/// failure is an Error of kind kOutput.
class StagedFolder {
 public:
  /// Creates the folder and, if it does not exist, `out`.
  explicit StagedFolder(std::filesystem::path out);
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Moves all files to the same places in `out` and replaces files of the same names.
  void Commit();

 private:
  std::filesystem::path out_;
  std::filesystem::path path_;
  bool made_out_ = false;
};

}  // namespace evo::app
