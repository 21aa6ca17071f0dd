#include "app/output_folder.hpp"

#include <unistd.h>

#include "evo/core/error.hpp"

namespace evo::app {

namespace fs = std::filesystem;

namespace {

/// The folder itself or the nearest one above it that exists.
fs::path NearestExisting(fs::path folder) {
  folder = fs::absolute(folder);
  std::error_code ignored;
  while (!fs::exists(folder, ignored) && folder.has_relative_path()) folder = folder.parent_path();
  return folder;
}

}  // namespace

void CheckOutputFolder(const fs::path& folder, const std::vector<std::string>& results, bool force) {
  const fs::path existing = NearestExisting(folder);
  if (!fs::is_directory(existing)) {
    throw Error(ErrorKind::kOutput, existing.string() + ": is not a folder; choose another --out folder");
  }
  if (::access(existing.c_str(), W_OK | X_OK) != 0) {
    throw Error(ErrorKind::kOutput, existing.string() + ": cannot be written to; choose another --out folder");
  }
  if (force) return;
  for (const auto& result : results) {
    if (fs::exists(folder / result)) {
      throw Error(ErrorKind::kOutput, folder.string() + ": already holds results (" + result +
                                          "); choose another --out folder or add --force to overwrite them");
    }
  }
}

}  // namespace evo::app
