#pragma once

#include "evo/core/parallel.hpp"
#include "odometry/bundle/bundle_problem.hpp"

namespace evo::odometry {

struct BundleOptions {
  int max_iterations = 20;
  double cauchy_width_px = 1.0;         ///< of the robust loss
  double drift_variance_ratio = 0.0;    ///< of tracks from observation to observation, see WhiteningStep
  double min_relative_decrease = 1e-8;  ///< of the cost in one iteration: converged below
};

struct BundleSummary {
  int iterations = 0;
  double initial_cost = 0.0;  ///< px^2
  double final_cost = 0.0;    ///< px^2
};

/// Refines poses and points together: Levenberg-Marquardt on Cauchy's loss of the reprojection errors' innovations and
/// of the changes of velocity. The points are eliminated by Schur's complement, the poses solved for by a skyline
/// Cholesky factorisation. The result does not depend on the number of threads of `pool`; null: this thread only.
BundleSummary AdjustBundle(const BundleOptions& options, BundleProblem* problem, ThreadPool* pool = nullptr);

}  // namespace evo::odometry
