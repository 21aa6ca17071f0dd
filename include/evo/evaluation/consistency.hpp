#pragma once

#include <span>
#include <vector>

#include "evo/evaluation/association.hpp"
#include "evo/evaluation/statistics.hpp"
#include "evo/geometry/trajectory.hpp"

namespace evo::evaluation {

/// How the errors of an estimate compare with what it says about its own uncertainty: squared errors over their
/// covariances for one degree of freedom ("NEES", Y. Bar-Shalom, X. R. Li, T. Kirubarajan: Estimation with Applications
/// to Tracking and Navigation, 2001, section 5.4). The mean is 1 if the covariances are honest, more if they are too
/// small. The poses of one run err together, so a single run scatters far more than its number of poses suggests.
struct Consistency {
  Statistics translation;
  Statistics rotation;
  Statistics pose;  ///< both together, with what they have in common
};

/// `covariances`, in order of time, belong to the pairs with the same t_estimate; pairs without one do not count. The
/// estimate is laid over the truth at the pose that is certain, whose covariance is zero; if `fit_scale`, then scaled
/// about it by least squares, as the covariances of a monocular path are meant. A run that was started anew has several
/// such poses, each with those after it. Without any there are no errors, and the statistics are empty.
Consistency MeasureConsistency(std::span<const PosePair> pairs,
                               std::span<const geometry::StampedCovariance> covariances, bool fit_scale);

}  // namespace evo::evaluation
