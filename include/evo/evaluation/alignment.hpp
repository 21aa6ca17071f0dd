#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "evo/geometry/se3.hpp"

namespace evo::evaluation {

/// p -> scale * R p + t, from the world frame of the estimate to that of the ground truth.
struct Similarity {
  double scale = 1.0;
  geometry::SE3 T_truth_estimate;

  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const;
  /// Scales the position only; the rotation stays a unit rotation.
  geometry::SE3 operator*(const geometry::SE3& T_world_cam) const;
};

/// How an estimate is aligned with the ground truth. The alignment is fitted to all matched poses or to the first ones
/// only; the errors after those are drift.
struct Alignment {
  enum class Method {
    kNone,
    kOrigin,       ///< maps the first estimated pose to the first true pose
    kOriginScale,  ///< kOrigin, then the least-squares scale about the first pose
    kScale,        ///< the scale of kSim3 alone, about the origin of the estimate's world frame, as in evo
    kPosYaw,       ///< least squares over translation and yaw (rpg's "posyaw"); one pose gives its position and the yaw
                   ///< that brings its axes nearest to the true ones
    kSe3,          ///< least squares over all positions without scale (S. Umeyama, PAMI 1991)
    kSim3,         ///< kSe3 with scale
  };
  Method method = Method::kOriginScale;
  std::optional<std::size_t> first_poses;  ///< number of matched poses in the fit, evo's n_to_align
  std::optional<double> first_seconds;     ///< time span of the poses in the fit, from the first one on
  std::string name = "origin-scale";       ///< as the user wrote it
};

/// Parses "none", "origin", "origin-scale", "scale", "posyaw", "se3" or "sim3"; the last five may carry a span, ":100"
/// (poses) or ":5s". "first:5" means sim3:5s. Throws Error (kUsage).
Alignment ParseAlignment(const std::string& text);
/// Parses a comma-separated list and drops repetitions.
std::vector<Alignment> ParseAlignments(const std::string& text);

}  // namespace evo::evaluation
