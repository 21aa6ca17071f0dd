#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace evo::tracking {

/// How near a feature's point is.
struct DepthSample {
  Eigen::Vector2d position;    ///< px
  double inverse_depth = 0.0;  ///< 1/s, see EgoMotion; 0: not known
};

/// Gradient of the inverse depth, 1/(px s), of the surface at `at`: the plane through it that most of the samples
/// around it lie on, by least squares that begin with a wide and end with a narrow robust loss. Samples at the very
/// position of `at` say nothing. Empty where too few agree.
std::optional<Eigen::Vector2d> SurfaceSlope(const std::vector<DepthSample>& samples, const DepthSample& at);

/// Median inverse depth of the few samples nearest to a place, 1/s. Empty where there are not that many.
std::optional<double> UsualInverseDepth(std::vector<DepthSample> samples, const Eigen::Vector2d& position);

}  // namespace evo::tracking
