#include "app/run/output_folder.hpp"

#include <unistd.h>

#include <regex>

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

void CheckRunFolder(const fs::path& folder, std::vector<std::string> results, bool force) {
  results.emplace_back("manifest.json");
  CheckOutputFolder(folder, results, force);
}

void RemoveResult(const fs::path& path) {
  std::error_code failure;
  fs::remove(path, failure);
  if (failure) {
    throw Error(ErrorKind::kOutput, path.string() + ": cannot remove this earlier result: " + failure.message());
  }
}

void RemoveResults(const fs::path& folder, const std::string& pattern) {
  const std::regex names(pattern);
  std::vector<fs::path> found;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    if (entry.is_regular_file() && std::regex_match(entry.path().filename().string(), names)) {
      found.push_back(entry.path());
    }
  }
  for (const auto& path : found) RemoveResult(path);
}

void RemovePlots(const fs::path& folder, const std::string& pattern) {
  RemoveResults(folder / "plots", "(" + pattern + ")\\.(dat|gp|svg|pdf)");
}

}  // namespace evo::app
