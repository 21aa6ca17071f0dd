#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace evo::io {

/// The content of a file, for `evo-run info`.
struct FileDescription {
  std::string kind;                                         ///< "MVSEC events", "trajectory", ...
  std::vector<std::pair<std::string, std::string>> values;  ///< name and value with its unit, in order of display
};

/// Describes an event recording, trajectory, ground truth, track file, calibration or sequence folder. HDF5 events are
/// sampled: their number comes from the shape, the stamps from the first and last row, sensor extent and polarity from
/// 16 places, which the value says. Throws Error (kInput) for a corrupt file or one of another kind.
FileDescription DescribeFile(const std::filesystem::path& path);

}  // namespace evo::io
