#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace evo::app {

/// Makes sure, before any work is done, that results can go to `folder`. Throws Error (kOutput) if it cannot be created
/// or written to, or if one of `results` (names relative to it) is there already, unless `force`. Nothing is created
/// or deleted yet.
void CheckOutputFolder(const std::filesystem::path& folder, const std::vector<std::string>& results, bool force);

/// Removes a file, which need not exist. Throws Error (kOutput).
void RemoveResult(const std::filesystem::path& path);
/// Removes the files of `folder`, which need not exist, whose whole name fits `pattern` (a regular expression), and
/// nothing else. Throws Error (kOutput).
void RemoveResults(const std::filesystem::path& folder, const std::string& pattern);
/// The same for all files of the plots with such names in folder/plots.
void RemovePlots(const std::filesystem::path& folder, const std::string& pattern);

}  // namespace evo::app
