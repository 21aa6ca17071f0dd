#pragma once

#include <filesystem>
#include <vector>

#include "evo/geometry/trajectory.hpp"

namespace evo::io {

/// Writes a table: a stamp and the upper triangle of its covariance, row by row, a line. Throws Error (kOutput).
void WritePoseCovariances(const std::filesystem::path& path,
                          const std::vector<geometry::StampedCovariance>& covariances);

/// Reads the table that WritePoseCovariances writes: one row or more, strictly increasing stamps, no negative variance.
/// Throws Error (kInput) with file and line.
std::vector<geometry::StampedCovariance> ReadPoseCovariances(const std::filesystem::path& path);

}  // namespace evo::io
