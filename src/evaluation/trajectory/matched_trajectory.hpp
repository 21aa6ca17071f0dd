#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "evaluation/trajectory/association.hpp"
#include "evo/core/time.hpp"
#include "evo/evaluation/alignment.hpp"

namespace evo::evaluation {

/// Aligned matched poses, prepared for relative errors between any two of them. All columns have one entry a pose;
/// coordinates are in the truth's world frame, lengths in m.
///
/// From pose i to pose j the estimate moves by R_i^T (p_j - p_i) and R_i^T R_j, the truth by the same terms of its own
/// poses (S, q). With D = R S^T, the rotation from the true orientation to the estimated one, the translation of the
/// relative error E = (true motion)^-1 (estimated motion) has the length |p_j - p_i - D_i (q_j - q_i)|, and its
/// rotation, seen in the world frame, is R_j (S_i^T S_j)^T (R_i^T R_j) R_j^T = D_j D_i^T.
struct MatchedTrajectory {
  std::vector<TimeNs> t;                           ///< clock of the truth
  std::vector<double> distance;                    ///< accumulated along the chords between matched true positions
  std::vector<Eigen::Vector3d> truth;              ///< q
  std::vector<Eigen::Vector3d> estimate;           ///< p, after alignment
  std::vector<Eigen::Quaterniond> rotation_error;  ///< D, after alignment

  std::size_t size() const { return t.size(); }
  /// Position error after the motion from pose `first` to pose `last` (m).
  double TranslationError(std::size_t first, std::size_t last) const;
  /// Rotation error after that motion, in the world frame.
  Eigen::Quaterniond RotationError(std::size_t first, std::size_t last) const;
};

MatchedTrajectory BuildMatchedTrajectory(std::span<const PosePair> pairs, const Similarity& similarity = {});

/// Angle of a rotation in [0, pi] (rad).
double RotationAngle(const Eigen::Quaterniond& rotation);

/// Parses a comma-separated list of path lengths: "100", "100m" (both m) or "10%" (of `path_m`), without repetitions.
/// Percentages of a path of length 0 are dropped. Throws Error (kConfiguration) for other texts, for lengths that are
/// not positive and for an empty list.
std::vector<double> ParseLengths(const std::string& text, double path_m);

}  // namespace evo::evaluation
