#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace evo::app {

/// Makes sure, before any work is done, that results can go to `folder`. Throws Error (kOutput) if it cannot be created
/// or written to, or if one of `results` (names relative to it) is there already, unless `force`. Nothing is created
/// yet and nothing is ever deleted: the results replace earlier ones as they are written.
void CheckOutputFolder(const std::filesystem::path& folder, const std::vector<std::string>& results, bool force);

}  // namespace evo::app
