#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace evo::io {

/// What a file holds, for `evo-run info`.
struct Description {
  std::string kind;                                         ///< "MVSEC events", "trajectory", ...
  std::vector<std::pair<std::string, std::string>> values;  ///< name and value with its unit, in order of display
};

/// Describes an event recording, trajectory, ground truth, track file or calibration, or a sequence folder. HDF5 events
/// are not read whole: their number comes from the shape, the stamps from the first and last row, the sensor extent and
/// the polarity from samples (and the value says so). Throws Error (kInput) on a corrupt file or one of another kind.
Description Describe(const std::filesystem::path& path);

}  // namespace evo::io
