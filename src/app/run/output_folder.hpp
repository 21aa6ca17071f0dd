#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace evo::app {

/// Checks before any work that results can go to `folder`. Throws Error (kOutput) if it cannot be created or written
/// to, or if it holds one of `results` (names relative to it) already, unless `force`. Nothing is created or deleted.
void CheckOutputFolder(const std::filesystem::path& folder, const std::vector<std::string>& results, bool force);

/// CheckOutputFolder() for `results` and manifest.json.
void CheckRunFolder(const std::filesystem::path& folder, std::vector<std::string> results, bool force);

/// Removes a file if it exists. Throws Error (kOutput).
void RemoveResult(const std::filesystem::path& path);
/// Removes the files of `folder` whose whole name matches the regular expression `pattern`. The folder need not exist.
/// Throws Error (kOutput).
void RemoveResults(const std::filesystem::path& folder, const std::string& pattern);
/// Removes all files of the plots of these names from folder/plots. Throws Error (kOutput).
void RemovePlots(const std::filesystem::path& folder, const std::string& pattern);

}  // namespace evo::app
