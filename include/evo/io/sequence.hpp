#pragma once

#include <filesystem>
#include <optional>

namespace evo::io {

/// The files of one recording.
struct SequenceFiles {
  std::filesystem::path events;
  std::optional<std::filesystem::path> calibration;
  std::optional<std::filesystem::path> ground_truth;
};

/// Finds the files of a recording from the path given as events. A file stands for itself. A folder holds UZH's
/// events.txt with optional calib.txt and groundtruth.txt, or one MVSEC *_data.hdf5 with an optional *_gt.hdf5 of the
/// same name and one optional camchain*.yaml. Throws Error (kInput) unless there is exactly one recording.
SequenceFiles FindSequence(const std::filesystem::path& path);

}  // namespace evo::io
