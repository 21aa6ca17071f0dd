#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "evo/core/parallel.hpp"
#include "evo/geometry/se3.hpp"
#include "evo/odometry/odometry_options.hpp"
#include "odometry/bundle/bundle_adjuster.hpp"

namespace evo::odometry {

/// How far the poses of an adjusted bundle may be off, from what is left of the errors: H^-1 (sum over tracks of g g^T)
/// H^-1, H the reduced system and g the part of its gradient of one track, or of one piece of a long track. So
/// whatever the errors of one have in common counts, and only the tracks have to be independent but for what is known
/// to be common (a sandwich estimator with clusters; K.-Y. Liang, S. L. Zeger, Biometrika 1986). The sum is taken by
/// random signs of the tracks, each of which gives one sample of all poses' errors.
class PoseUncertainty {
 public:
  PoseUncertainty() = default;
  /// At a minimum that AdjustBundle has found with the same options. Does not depend on the number of threads.
  PoseUncertainty(const CovarianceOptions& common, const BundleOptions& options, const BundleProblem& problem,
                  ThreadPool* pool = nullptr);

  /// [begin, end) of the poses without those at either end, at most a tenth of all, whose turn towards the others is
  /// much more uncertain by the tracks than is usual within the run: a few, just born or the last that are left, know
  /// little, and the first pose turns the whole path.
  std::pair<std::size_t, std::size_t> CertainStretch() const { return certain_; }
  /// False if the system was singular: then nothing is known.
  bool known() const { return known_; }
  /// Forgets all poses but [begin, end).
  void Cut(std::size_t begin, std::size_t end);

  /// From elsewhere the scale along the path is known to the relative standard deviation `error`, whose correlation
  /// falls to 1 / e over a way of `reach`. `T_cam_world` are the poses with that scale, of the same rotations.
  void HoldScale(const std::vector<geometry::SE3>& T_cam_world, double error, double reach);

  /// Of the left twists (translation, rotation) of all poses relative to `origin`, which itself has none. The scale is
  /// the problem's, or, if `scale_is_free`, the one that fits the true path best by least squares with the origin held,
  /// as where the path is aligned with it so.
  std::vector<geometry::Matrix6d> Covariances(std::size_t origin, bool scale_is_free) const;
  /// Standard deviation of the camera's turn from one pose to another, rad.
  double Turn(std::size_t from, std::size_t to) const;

 private:
  using Rows = Eigen::Matrix<double, 6, Eigen::Dynamic>;

  std::pair<std::size_t, std::size_t> FindCertainStretch() const;
  /// Of the pose's errors relative to those of `origin`.
  Rows Relative(std::size_t pose, std::size_t origin) const;

  bool known_ = false;
  std::pair<std::size_t, std::size_t> certain_;
  std::vector<geometry::SE3> poses_;
  Eigen::MatrixXd samples_;  // of the left twists' errors, six rows for every pose
};

}  // namespace evo::odometry
