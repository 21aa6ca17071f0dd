#pragma once

#include <Eigen/Core>
#include <vector>

#include "odometry/bundle/bundle_adjuster.hpp"

namespace evo::odometry {

/// Errors beyond so many standard deviations are outliers.
inline constexpr double kOutlierSigmas = 5.0;

/// Standard deviation of a coordinate of the errors, from the median of their norms; px, never quite 0.
double MeasureNoise(const std::vector<Eigen::Vector2d>& errors);

/// Sets the weights of all points: some tracks follow a sharp corner, others a smudge, and each has its own noise. Its
/// variance is drawn from an inverse gamma distribution about the usual one and estimated with the innovations that the
/// problem leaves at present (see InnovationStep); the median weight is 1.
void WeighTracks(double drift, BundleProblem* problem);

}  // namespace evo::odometry
