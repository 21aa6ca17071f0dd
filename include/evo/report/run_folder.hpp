#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "evo/report/csv.hpp"
#include "evo/report/manifest.hpp"

namespace evo::report {

/// The results in the output folder of a run that a comparison of runs needs.
struct RunFolder {
  std::filesystem::path path;
  std::string name;                 ///< of the folder, with parent folders where names would be equal
  std::string failure;              ///< error of the run in one line; empty for a completed run
  std::optional<CsvTable> summary;  ///< summary.csv; empty for a failed run
  std::vector<std::pair<std::string, std::string>> lifetimes;  ///< columns of runs.csv from lifetime.csv
  std::optional<Manifest> manifest;
  std::vector<std::string> warnings;          ///< lines of log.txt that begin with "warning:"
  std::vector<std::filesystem::path> plots;   ///< plots/*.svg, by name
  std::vector<std::filesystem::path> sheets;  ///< images/four_frames_*.png, by name
};

/// Reads the folders in the given order, each once. A run has failed if it left a failure.txt, which holds the reason,
/// or no manifest.json, which every command writes last. Throws Error (kInput) for missing folders, folders without
/// results, and corrupt files.
std::vector<RunFolder> ReadRunFolders(const std::vector<std::filesystem::path>& paths);

}  // namespace evo::report
