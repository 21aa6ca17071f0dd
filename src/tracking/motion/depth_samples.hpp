#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace evo::tracking {

/// Inverse depth of a feature's point.
struct DepthSample {
  Eigen::Vector2d position;    ///< px
  double inverse_depth = 0.0;  ///< in units of the speed, 1/s, see EgoMotion; 0: unknown
};

/// Gradient of the inverse depth, 1/(px s), of the surface at `at`: that of the plane through `at` on which most
/// samples around it lie. Iteratively reweighted least squares, with a loss that narrows from one iteration to the
/// next. Samples at the very position of `at` are ignored. Empty if too few samples agree.
std::optional<Eigen::Vector2d> FitInverseDepthGradient(const std::vector<DepthSample>& samples, const DepthSample& at);

/// Median inverse depth of the few samples nearest to `position`, 1/s. Empty if there are too few.
std::optional<double> MedianInverseDepth(std::vector<DepthSample> samples, const Eigen::Vector2d& position);

}  // namespace evo::tracking
