#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "evo/io/pixel_files.hpp"

namespace evo::io {

/// The content of a file, for `evo-run info`.
struct FileDescription {
  std::string kind;                                         ///< "MVSEC events", "trajectory", ...
  std::vector<std::pair<std::string, std::string>> values;  ///< name and value with its unit, in order of display
};

/// Describes an event recording, trajectory, ground truth, track file, calibration or sequence folder. HDF5 events are
/// sampled: their number comes from the shape, the stamps from the first and last row, sensor extent and polarity from
/// 16 places, which the value says. With a `mask` the extent and polarity are those of the events outside it. Throws
/// Error (kInput) for a corrupt file or one of another kind.
FileDescription DescribeFile(const std::filesystem::path& path, const Mask* mask = nullptr);

}  // namespace evo::io
