#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "evo/geometry/trajectory.hpp"

namespace evo::io {

/// Which of an MVSEC file's two trajectories is the truth.
enum class GroundTruthSource {
  kLoam,          ///< `davis/left/odometry`: locally consistent, drifts
  kCartographer,  ///< `davis/left/pose`: loop-closed in the plane, or motion capture indoors
};

/// Reads lines `t px py pz qx qy qz qw` (TUM, also UZH's groundtruth.txt): T_world_cam, seconds, metres, Hamilton
/// quaternion of norm 1 within 1e-3; no farther than 1e12 m from the origin, here and below. Lines starting with `#`
/// are comments. Throws Error (kInput) with file and line; stamps must strictly increase and there must be a pose.
geometry::Trajectory ReadTum(const std::filesystem::path& path);

/// Reads a KITTI pose file: rows of 12 numbers, the first three rows of T_world_cam, row by row, in metres. There are
/// no stamps: the n-th pose (from 0) gets n seconds. Throws Error (kInput) with file and line.
geometry::Trajectory ReadKitti(const std::filesystem::path& path);

/// Reads the `source` of an MVSEC _gt.hdf5 (N x 4 x 4 row-major T_world_cam and N stamps in seconds) or, whatever the
/// source, a TUM text, told by content. Throws Error (kInput) with file and row.
geometry::Trajectory ReadGroundTruth(const std::filesystem::path& path, GroundTruthSource source);

/// Writes a TUM text: single spaces, stamps with nine decimals, the rest with twelve.
/// Throws Error (kOutput, or kInput for a pose that is not finite).
void WriteTum(const std::filesystem::path& path, const geometry::Trajectory& trajectory);

/// Writes a row `timestamp` and the upper triangle, row by row, of each covariance. Throws Error (kOutput).
void WritePoseCovariances(const std::filesystem::path& path,
                          const std::vector<geometry::StampedCovariance>& covariances);

/// Reads what WritePoseCovariances writes. Throws Error (kInput) with file and line; stamps must strictly increase, no
/// variance may be negative and there must be a row.
std::vector<geometry::StampedCovariance> ReadPoseCovariances(const std::filesystem::path& path);

}  // namespace evo::io
