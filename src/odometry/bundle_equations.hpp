#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "evo/odometry/block_skyline.hpp"
#include "evo/odometry/bundle_adjuster.hpp"

namespace evo {

/// Cauchy's loss of a squared error, and the weight that it gives to the error.
inline double CauchyCost(double squared, double width) {
  return 0.5 * width * width * std::log1p(squared / (width * width));
}
inline double CauchyWeight(double squared, double width) { return 1.0 / (1.0 + squared / (width * width)); }

/// The normal equations of a bundle problem at its present values, the points' part kept apart.
class BundleEquations {
 public:
  /// `begin[p]` is the first observation of point p, `begin[p + 1]` the end of its observations. What is referred to
  /// must outlive this object. The present distance of the scale frame is the one that is held.
  BundleEquations(const BundleProblem& problem, double loss_px, const std::vector<std::size_t>& begin);

  void Linearize();

  /// Steps of poses (left twists) and points for a damping `lambda`; false if the system is singular.
  bool Solve(double lambda, Eigen::VectorXd* pose_steps, std::vector<Eigen::Vector3d>* point_steps);

 private:
  int Pose(std::size_t observation) const { return problem_.observations[observation].frame - problem_.fixed_frames; }
  void LinearizePoint(std::size_t p);
  void LinearizeScale();
  void EliminatePoint(std::size_t p, double lambda, Eigen::VectorXd* right);

  const BundleProblem& problem_;
  double width_;
  const std::vector<std::size_t>& begin_;
  double scale_length_;
  BlockSkyline reduced_;
  std::vector<BlockSkyline::Block> pose_blocks_;
  std::vector<Eigen::Matrix<double, 6, 3>> cross_;
  std::vector<Eigen::Matrix3d> point_blocks_;
  std::vector<Eigen::Matrix3d> inverses_;
  std::vector<Eigen::Vector3d> point_gradients_;
  Eigen::VectorXd pose_gradient_;
};

}  // namespace evo
