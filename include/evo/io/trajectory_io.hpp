#pragma once

#include <filesystem>

#include "evo/geometry/trajectory.hpp"

namespace evo::io {

/// The trajectory of an MVSEC _gt.hdf5 that serves as ground truth.
enum class GroundTruthSource {
  kLoam,          ///< `davis/left/odometry`: locally consistent, drifts
  kCartographer,  ///< `davis/left/pose`: loop-closed in the plane, or motion capture indoors
};

/// Reads lines `t px py pz qx qy qz qw` (TUM and UZH's groundtruth.txt): T_world_cam in seconds and metres, a Hamilton
/// quaternion of norm 1 within 1e-3, positions within 1e12 m (here and below). Lines with `#` are comments. The file
/// must hold a pose and its stamps must strictly increase. Throws Error (kInput) with file and line.
geometry::Trajectory ReadTum(const std::filesystem::path& path);

/// Reads a KITTI pose file: rows of 12 numbers, the upper three rows of T_world_cam in metres. The format has no
/// stamps: pose number n (from 0) gets n seconds. Throws Error (kInput) with file and line.
geometry::Trajectory ReadKitti(const std::filesystem::path& path);

/// Reads the `source` of an MVSEC _gt.hdf5 (N x 4 x 4 row-major T_world_cam and N stamps in seconds) or a TUM text,
/// where `source` does not matter. The content tells the format. Throws Error (kInput) with file and row.
geometry::Trajectory ReadGroundTruth(const std::filesystem::path& path, GroundTruthSource source);

/// Writes a TUM text: single spaces, stamps with nine decimals, all other numbers with twelve.
/// Throws Error (kOutput, or kInput for a pose that is not finite).
void WriteTum(const std::filesystem::path& path, const geometry::Trajectory& trajectory);

}  // namespace evo::io
