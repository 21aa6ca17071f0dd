#pragma once

#include <optional>

#include "evo/core/parallel.hpp"
#include "evo/odometry/odometry_options.hpp"
#include "odometry/bundle/bundle_adjuster.hpp"
#include "odometry/uncertainty/pose_error_samples.hpp"

namespace evo::odometry {

/// The errors that the poses of an adjusted bundle may have.
struct PoseUncertainty {
  PoseErrorSamples errors;
  /// All poses but those at either end, at most a tenth of all, whose rotation is much more uncertain by the tracks
  /// than the typical one: a few young tracks, or the last ones left, know little, and the first pose rotates the whole
  /// path.
  PoseRange certain_range;
};

/// Estimates the errors of the poses from the residuals at a minimum that AdjustBundle has found with the same options;
/// empty if the system is singular. The covariance is a sandwich with the tracks as clusters (K.-Y. Liang, S. L. Zeger:
/// Longitudinal Data Analysis Using Generalized Linear Models, Biometrika 1986),
///     variance_inflation * H^-1 (sum over tracks of g g^T) H^-1,
/// with the reduced system H and the part g of its gradient that a track, or a piece of a long track, has. So errors
/// may be correlated within a track but not between tracks, except for those in `covariance`. The sum is sampled by
/// random signs of the tracks, each of which gives one sample of all poses' errors (the score bootstrap; P. Kline,
/// A. Santos, J. of Econometric Methods 2012). The result does not depend on the number of threads.
std::optional<PoseUncertainty> EstimatePoseUncertainty(const CovarianceOptions& covariance,
                                                       const BundleOptions& options, const BundleProblem& problem,
                                                       ThreadPool* pool = nullptr);

}  // namespace evo::odometry
