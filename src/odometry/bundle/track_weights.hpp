#pragma once

#include <Eigen/Core>
#include <vector>

#include "odometry/bundle/bundle_problem.hpp"

namespace evo::odometry {

/// Errors beyond this many standard deviations are outliers.
inline constexpr double kOutlierSigmas = 5.0;

/// Robust standard deviation of a coordinate of the errors in px, from the median of their norms; at least 0.05.
double EstimateNoise(const std::vector<Eigen::Vector2d>& errors_px);

/// Sets the weight of every point from its track's own noise: one track follows a sharp corner, another a blurred one.
/// The noise variance has a scaled inverse chi-squared prior about the typical one (A. Gelman et al.: Bayesian Data
/// Analysis, section 2.6) and is estimated from the innovations of the problem's present values. The median weight
/// is 1.
void SetTrackWeights(double drift_variance_ratio, BundleProblem* problem);

}  // namespace evo::odometry
