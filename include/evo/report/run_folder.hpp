#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "evo/report/csv.hpp"
#include "evo/report/manifest.hpp"

namespace evo::report {

/// What a run left in its output folder, as far as a comparison of runs needs it.
struct RunFolder {
  std::filesystem::path path;
  std::string name;                 ///< the folder's own; with the folders above it where two would have the same
  std::string failure;              ///< what went wrong, in one line; empty for a run that was completed
  std::optional<CsvTable> summary;  ///< summary.csv; never of a failed run
  std::vector<std::pair<std::string, std::string>> lifetimes;  ///< columns for the table of runs, from lifetime.csv
  std::optional<Manifest> manifest;
  std::vector<std::string> warnings;          ///< lines of log.txt that begin with "warning:"
  std::vector<std::filesystem::path> plots;   ///< plots/*.svg, by name
  std::vector<std::filesystem::path> sheets;  ///< images/four_frames_*.png, by name
};

/// Reads the folders in the order given, each once. A run has failed if there is a failure.txt, whose text says why, or
/// no manifest.json, which every command writes last. Throws Error (kInput) for what is no folder or holds nothing that
/// a run leaves, and for files that are corrupt.
std::vector<RunFolder> ReadRunFolders(const std::vector<std::filesystem::path>& paths);

}  // namespace evo::report
