#pragma once

#include <filesystem>
#include <initializer_list>

namespace evo::io {

/// The kind of a file by its first bytes and lines, never by its name.
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

/// The kind in a message, such as "a track file".
const char* KindName(FileKind kind);

/// Throws Error (kInput) if the file is missing or unreadable.
FileKind DetectKind(const std::filesystem::path& path);

/// Throws Error (kInput) unless the file is of an `accepted` kind; the message names what is `expected`. Text of an
/// unknown kind passes, since its reader names the faulty line.
void RequireKind(const std::filesystem::path& path, std::initializer_list<FileKind> accepted, const char* expected);

}  // namespace evo::io
