#pragma once

#include <span>

#include "evaluation/trajectory/association.hpp"
#include "evo/evaluation/trajectory_errors.hpp"
#include "evo/geometry/trajectory.hpp"

namespace evo::evaluation {

/// Computes the NEES of all pairs that have a covariance of the same `t_estimate`; `covariances` are in order of time.
///
/// A pose of zero covariance is the gauge origin of the ones after it: the estimate is aligned with the truth at that
/// pose and, with `fit_scale`, scaled about it by least squares, as the covariances of a monocular path require. A run
/// that reinitialises has several origins. Without an origin the statistics are empty.
Nees ComputeNees(std::span<const PosePair> pairs, std::span<const geometry::StampedCovariance> covariances,
                 bool fit_scale);

}  // namespace evo::evaluation
