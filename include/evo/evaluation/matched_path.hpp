#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/evaluation/alignment.hpp"
#include "evo/evaluation/association.hpp"

namespace evo::evaluation {

/// Matched poses laid over the truth, prepared for errors of motion between any two of them. All columns have one entry
/// a pose; lengths in m, coordinates in the truth's world frame.
///
/// From pose i to pose j the estimate moves by R_i^T (p_j - p_i) and turns by R_i^T R_j, the truth likewise by its own
/// poses (S, q). Of the error E = (true motion)^-1 (estimated motion) only two things are needed, and both follow from
/// the turn D = R S^T that takes the truth's orientation to the estimate's: the length of its translation is
/// |p_j - p_i - D_i (q_j - q_i)|, and its rotation, seen in the world, is R_j (S_i^T S_j)^T (R_i^T R_j) R_j^T =
/// D_j D_i^T.
struct MatchedPath {
  std::vector<TimeNs> t;                       ///< clock of the truth
  std::vector<double> distance;                ///< along the chords between matched true positions, from the first one
  std::vector<Eigen::Vector3d> truth;          ///< q
  std::vector<Eigen::Vector3d> estimate;       ///< p, after alignment
  std::vector<Eigen::Quaterniond> difference;  ///< D, after alignment

  std::size_t size() const { return t.size(); }
  /// Error of position after the motion from pose `first` to pose `last`, m.
  double TranslationError(std::size_t first, std::size_t last) const;
  /// Error of orientation after that motion, in the world frame.
  Eigen::Quaterniond RotationError(std::size_t first, std::size_t last) const;
};

MatchedPath MatchPath(std::span<const PosePair> pairs, const Similarity& similarity = {});

/// Angle of a rotation, rad, in [0, pi].
double Angle(const Eigen::Quaterniond& rotation);

/// Reads a comma-separated list of lengths of path: "100", "100m" (both m) or "10%" (of `path_m`), each taken once.
/// Shares of a path without length are left out. Throws Error (kConfiguration) for anything else, for lengths that are
/// not positive and for an empty list.
std::vector<double> ParseLengths(const std::string& text, double path_m);

}  // namespace evo::evaluation
