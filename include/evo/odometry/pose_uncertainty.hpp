#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "evo/core/parallel.hpp"
#include "evo/geometry/se3.hpp"
#include "evo/odometry/bundle_adjuster.hpp"

namespace evo {

/// How far the poses of an adjusted bundle may be off, from what is left of the errors: H^-1 (sum over tracks of g g^T)
/// H^-1, H the reduced system and g one track's part of its gradient. So whatever the errors of one track have in
/// common counts, and only the tracks have to be independent (a sandwich estimator with clusters; K.-Y. Liang, S. L.
/// Zeger, Biometrika 1986). The sum is taken by random signs of the tracks, each of which gives one sample of all
/// poses' errors.
class PoseUncertainty {
 public:
  /// At a minimum that AdjustBundle has found with the same options. Does not depend on the number of threads.
  PoseUncertainty(const BundleOptions& options, const BundleProblem& problem, ThreadPool* pool = nullptr);

  /// Of the left twists (translation, rotation) of all poses relative to `origin`, which itself has none; the scale is
  /// the problem's. All zero if the system was singular.
  std::vector<Matrix6d> Covariances(std::size_t origin) const;
  /// Standard deviation of the camera's turn from one pose to another, rad.
  double Turn(std::size_t from, std::size_t to) const;
  /// [begin, end) of the poses without those at either end, at most a tenth of all, whose turn towards the others is
  /// far more uncertain than is usual within the run: a few tracks, just born or the last that are left, know little,
  /// and the first pose turns the whole path.
  std::pair<std::size_t, std::size_t> CertainStretch() const;

 private:
  std::vector<SE3> poses_;
  Eigen::MatrixXd samples_;  // six rows for every pose
};

}  // namespace evo
