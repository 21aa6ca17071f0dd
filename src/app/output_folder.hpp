#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace evo::app {

/// Makes sure, before any work is done, that results can go to `folder`: creates it where needed and throws Error
/// (kOutput) if it cannot be written to or if one of `results` (names relative to it) is there already, unless `force`.
/// Nothing is ever deleted: results are replaced one by one as they are written.
void PrepareOutputFolder(const std::filesystem::path& folder, const std::vector<std::string>& results, bool force);

}  // namespace evo::app
