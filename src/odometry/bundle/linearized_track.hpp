#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "odometry/bundle/bundle_problem.hpp"
#include "odometry/bundle/reprojection.hpp"
#include "odometry/bundle/whitening_filter.hpp"

namespace evo::odometry {

/// Noise of the reprojection errors and the loss of their innovations.
struct NoiseModel {
  std::vector<WhiteningStep> whitening;  ///< of all observations
  double cauchy_width_px;                ///< of an innovation
  /// True: the Hessian has the mean second derivative of Cauchy's loss, which tells how certain a minimum is. False: it
  /// has the loss's weight, which is larger and makes the steps towards the minimum safer.
  bool use_second_derivative = false;

  std::span<const WhiteningStep> Whitening(std::size_t begin, std::size_t end) const {
    return std::span(whitening).subspan(begin, end - begin);
  }
};

/// The reprojection errors of one point's observations at the present values, weighted: with the errors e, their
/// Jacobian J, and the weight matrices W (of the gradient) and H (of the Hessian) the normal equations are
/// J^T H J step = -J^T W e.
class LinearizedTrack {
 public:
  /// `[begin, end)` are the observations of the point.
  void Linearize(const BundleProblem& problem, const NoiseModel& noise, std::size_t begin, std::size_t end);

  /// Zero for an observation behind the camera.
  const LinearizedReprojection& observation(std::size_t k) const { return observations_[k]; }
  /// Entry of H.
  double hessian_weight(std::size_t k, std::size_t l) const {
    return HessianWeights()(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(l));
  }

  /// Row k of W e and of H J_error_point.
  struct WeightedRow {
    Eigen::Vector2d error = Eigen::Vector2d::Zero();
    Eigen::Matrix<double, 2, 3> J_error_point = Eigen::Matrix<double, 2, 3>::Zero();
  };
  WeightedRow ComputeWeightedRow(std::size_t k) const;

 private:
  const Eigen::MatrixXd& HessianWeights() const { return has_hessian_weights_ ? hessian_weights_ : gradient_weights_; }

  std::vector<LinearizedReprojection> observations_;
  Eigen::MatrixXd gradient_weights_;  // W, one image coordinate
  Eigen::MatrixXd hessian_weights_;   // H, one image coordinate
  bool has_hessian_weights_ = false;  // else H is W
  std::vector<Eigen::Vector2d> errors_, innovations_;
  std::vector<double> innovation_weights_;
};

}  // namespace evo::odometry
