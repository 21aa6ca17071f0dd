#pragma once

#include <filesystem>
#include <initializer_list>

namespace evo::io {

/// What a file is, told by its first bytes and lines, never by its name.
enum class FileKind {
  kHdf5,
  kEventText,        ///< `t x y p`
  kTrajectoryText,   ///< `t px py pz qx qy qz qw`
  kKittiPoses,       ///< rows of 12 numbers, the upper three rows of a pose's matrix
  kTrackText,        ///< `id t x y` or `t,x,y,theta,id`
  kCalibrationText,  ///< `fx fy cx cy k1 k2 p1 p2 k3`
  kCalibrationYaml,  ///< Kalibr camchain
  kOtherText,
  kPng,
  kBinary,
  kEmpty,
  kFolder,
};

/// "a track file", "a folder": for messages.
const char* KindName(FileKind kind);

/// Throws Error (kInput) if there is no such file or it cannot be read.
FileKind DetectKind(const std::filesystem::path& path);

/// Throws Error (kInput) unless the file is of one of the `accepted` kinds. `expected` says in the message what to give
/// instead. Text of no known kind passes: the reader of it names the line that is wrong.
void RequireKind(const std::filesystem::path& path, std::initializer_list<FileKind> accepted, const char* expected);

}  // namespace evo::io
