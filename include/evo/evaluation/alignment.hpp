#pragma once

#include <span>
#include <string>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/evaluation/association.hpp"
#include "evo/geometry/se3.hpp"

namespace evo {

/// p -> scale * R p + t: takes the estimate's world frame to that of the ground truth.
struct Similarity {
  double scale = 1.0;
  SE3 T_truth_estimate;

  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const;
  /// The pose keeps its unit rotation; only its position is scaled.
  SE3 operator*(const SE3& T_world_cam) const;
};

/// How an estimate is laid over the ground truth before errors are taken.
struct Alignment {
  enum class Kind {
    kNone,
    kOrigin,       ///< the first pose is laid on the first true pose
    kOriginScale,  ///< the same, then one scale about it that makes the squared position errors least
    kSe3,          ///< least squares over all positions (Umeyama 1991, without scale)
    kSim3,         ///< the same with scale
    kFirst,        ///< Sim3 over the first `seconds` only: the errors after them are drift
  };
  Kind kind = Kind::kOriginScale;
  double seconds = 0.0;  ///< kFirst only
  std::string name = "origin-scale";
};

/// Reads "none", "origin", "origin-scale", "se3", "sim3" or "first:SECONDS"; an Error (kUsage) for anything else.
Alignment ParseAlignment(const std::string& text);
/// A comma-separated list of them, none twice.
std::vector<Alignment> ParseAlignments(const std::string& text);

/// Throws Error (kDegenerateAlignment) where the pairs do not determine what is asked for: positions on a line or a
/// point, a standing camera, fewer than three poses for the least-squares alignments.
Similarity Align(std::span<const PosePair> pairs, const Alignment& alignment);

}  // namespace evo
