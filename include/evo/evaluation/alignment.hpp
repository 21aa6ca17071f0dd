#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/evaluation/association.hpp"
#include "evo/geometry/se3.hpp"

namespace evo::evaluation {

/// p -> scale * R p + t: takes the estimate's world frame to that of the ground truth.
struct Similarity {
  double scale = 1.0;
  geometry::SE3 T_truth_estimate;

  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const;
  /// The pose keeps its unit rotation; only its position is scaled.
  geometry::SE3 operator*(const geometry::SE3& T_world_cam) const;
};

/// How an estimate is laid over the ground truth before errors are taken: by a method, determined from all matched
/// poses or from those at the beginning only, so that the errors after them are drift.
struct Alignment {
  enum class Method {
    kNone,
    kOrigin,       ///< the first pose is laid on the first true pose
    kOriginScale,  ///< the same, then one scale about it that makes the squared position errors least
    kScale,        ///< the scale of kSim3 alone, about the origin of the estimate's world, as evo does
    kPosYaw,       ///< least squares over translation and rotation about the up direction (rpg's "posyaw"); from one
                   ///< pose: its position, and the rotation that brings its axes nearest to the true ones
    kSe3,          ///< least squares over all positions (Umeyama 1991, without scale)
    kSim3,         ///< the same with scale
  };
  Method method = Method::kOriginScale;
  std::optional<std::size_t> first_poses;  ///< only so many matched poses count, evo's n_to_align
  std::optional<double> first_seconds;     ///< only those up to so long after the first one count
  std::string name = "origin-scale";       ///< as written
};

/// Reads "none", "origin", "origin-scale", "scale", "posyaw", "se3" or "sim3", of which the last five may be
/// followed by a span, ":100" (poses) or ":5s"; "first:5" is sim3:5s. An Error (kUsage) for anything else.
Alignment ParseAlignment(const std::string& text);
/// A comma-separated list of them, none twice.
std::vector<Alignment> ParseAlignments(const std::string& text);

/// `up` is a unit vector in the truth's world; only posyaw needs it. Throws Error (kDegenerateAlignment) where the
/// pairs do not determine what is asked for: positions on a line or a point, a standing camera, fewer than three poses
/// for the least-squares alignments.
Similarity Align(std::span<const PosePair> pairs, const Alignment& alignment, const Eigen::Vector3d& up);

}  // namespace evo::evaluation
