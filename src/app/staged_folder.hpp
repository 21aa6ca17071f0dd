#pragma once

#include <filesystem>

namespace evo::app {

/// A temporary folder within the one of the results, for results that are of use only together: they are written into
/// path() and appear in `out` at once with Commit(). Without it nothing is left, also when InterruptGuard ends the
/// process. Failures are Errors of kind kOutput.
class StagedFolder {
 public:
  /// Creates it, and `out` if need be.
  explicit StagedFolder(std::filesystem::path out);
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Moves all files to the same places in `out`, over those of the same names there.
  void Commit();

 private:
  std::filesystem::path out_;
  std::filesystem::path path_;
  bool made_out_ = false;
};

}  // namespace evo::app
