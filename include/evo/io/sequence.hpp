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

/// Resolves what the user gave as events. A file stands for itself alone. In a folder: UZH's events.txt with calib.txt
/// and groundtruth.txt where they exist, or the only MVSEC *_data.hdf5 with the *_gt.hdf5 of that name and the only
/// camchain*.yaml. Throws Error (kInput) if there is no such file or the folder holds no, or more than one, recording.
SequenceFiles FindSequence(const std::filesystem::path& path);

}  // namespace evo::io
