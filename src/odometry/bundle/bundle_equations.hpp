#pragma once

#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <span>
#include <vector>

#include "odometry/bundle/block_skyline.hpp"
#include "odometry/bundle/bundle_adjuster.hpp"
#include "odometry/bundle/track_noise.hpp"

namespace evo::odometry {

/// Cauchy's loss of a squared error, and the weight that it gives to the error.
inline double CauchyCost(double squared, double width) {
  return 0.5 * width * width * std::log1p(squared / (width * width));
}
inline double CauchyWeight(double squared, double width) { return 1.0 / (1.0 + squared / (width * width)); }

/// Calls work(i) for every i in [0, count), on all threads of `pool` if there is one, so many at a time.
inline void ForEachIndex(ThreadPool* pool, std::size_t count, std::size_t chunk,
                         const std::function<void(std::size_t)>& work) {
  if (pool) {
    pool->ForEach(count, work, chunk);
  } else {
    for (std::size_t i = 0; i < count; ++i) work(i);
  }
}

/// Of every point its first observation, and the number of all observations at the end.
std::vector<std::size_t> FirstObservations(const BundleProblem& problem);

/// Of all observations, with the magnifications at the problem's present values.
std::vector<InnovationStep> InnovationSteps(const BundleProblem& problem, double drift);

/// What errors are thought to be like, and how much a large one counts.
struct ErrorModel {
  std::vector<InnovationStep> steps;  ///< of all observations
  double loss_px;                     ///< Cauchy's width, of an innovation
  /// The tracks' equations get the loss's mean second derivative, as they ought to where they tell how certain the
  /// minimum is. Else they get its weight, which is larger: surer steps towards it.
  bool curvature = false;

  std::span<const InnovationStep> Steps(std::size_t begin, std::size_t end) const {
    return std::span(steps).subspan(begin, end - begin);
  }
};

/// What one point's sightings say at the present values.
struct TrackEquations {
  std::vector<BundleJacobian> sightings;  ///< null behind the camera
  Eigen::MatrixXd information;            ///< of their errors, one coordinate: what the gradient is made of

  /// The same for the second derivative.
  const Eigen::MatrixXd& curvature() const { return has_curvature_ ? curvature_ : information; }

  /// `[begin, end)` are the observations of the point.
  void Linearize(const BundleProblem& problem, const ErrorModel& model, std::size_t begin, std::size_t end);
  /// The sums over all sightings j of information(i, j) times their error, and of curvature(i, j) times their
  /// derivative by the point.
  Eigen::Vector2d Weighted(std::size_t i, Eigen::Matrix<double, 2, 3>* by_point) const;

 private:
  std::vector<Eigen::Vector2d> errors_, innovations_;
  std::vector<double> weights_;
  Eigen::MatrixXd curvature_;
  bool has_curvature_ = false;
};

/// The normal equations of a bundle problem at its present values, the points' part kept apart.
class BundleEquations {
 public:
  /// `begin[p]` is the first observation of point p, `begin[p + 1]` the end of its observations. What is referred to
  /// must outlive this object. The present distance of the scale frame is the one that is held.
  BundleEquations(const BundleProblem& problem, const ErrorModel& model, const std::vector<std::size_t>& begin,
                  ThreadPool* pool);

  void Linearize();

  /// Steps of poses (left twists) and points for a damping `lambda`; false if the system is singular.
  bool Solve(double lambda, Eigen::VectorXd* pose_steps, std::vector<Eigen::Vector3d>* point_steps);

  /// Reduces and factorises the system without damping; false if it is singular.
  bool Factorize();
  /// After that: the poses' steps if every track's part of the gradient had that sign.
  Eigen::VectorXd StepsIf(const std::vector<double>& signs) const;

 private:
  int Pose(std::size_t observation) const { return problem_.observations[observation].frame - problem_.fixed_frames; }
  /// Calls work(p) for all points, on all threads, no two of which see the same pose at once.
  void ForEachPoint(const std::function<void(std::size_t)>& work);
  void LinearizePoint(std::size_t p);
  void LinearizeScale();
  void LinearizeMotion();
  /// The reduced system into `reduced_` and `right`.
  void Reduce(double lambda, Eigen::VectorXd* right);
  void EliminatePoint(std::size_t p, double lambda, Eigen::VectorXd* right);

  const BundleProblem& problem_;
  const ErrorModel& model_;
  const std::vector<std::size_t>& begin_;
  ThreadPool* pool_;
  std::vector<std::size_t> batches_;  // of points: where each begins, and the end of all
  double scale_length_;
  BlockSkyline poses_;    // the poses' part
  BlockSkyline reduced_;  // the same without the points
  std::vector<Eigen::Matrix<double, 6, 3>> cross_;
  std::vector<geometry::Vector6d> pulls_;  // of every observation on its pose
  std::vector<Eigen::Matrix3d> point_blocks_;
  std::vector<Eigen::Matrix3d> inverses_;
  std::vector<Eigen::Vector3d> point_gradients_;
  Eigen::VectorXd pose_gradient_;
};

}  // namespace evo::odometry
