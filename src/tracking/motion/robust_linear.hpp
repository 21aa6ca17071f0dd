#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "evo/core/robust.hpp"

namespace evo::tracking {

/// A measurement of unknowns x: value = jacobian * x + noise.
template <int kRows, int kUnknowns>
struct LinearMeasurement {
  Eigen::Matrix<double, kRows, kUnknowns> jacobian;
  Eigen::Matrix<double, kRows, 1> value;
};

/// Robust linear least squares: the x that minimises the Cauchy loss of |value - jacobian * x| over all measurements
/// plus x^T diag(prior) x, by iteratively reweighted least squares from 0 on. `width` of the loss is in the unit of the
/// values, and the prior in that of the squared Jacobians.
template <int kRows, int kUnknowns>
Eigen::Matrix<double, kUnknowns, 1> SolveRobust(const std::vector<LinearMeasurement<kRows, kUnknowns>>& measurements,
                                                const Eigen::Matrix<double, kUnknowns, 1>& prior, double width,
                                                int iterations) {
  using Vector = Eigen::Matrix<double, kUnknowns, 1>;
  Vector x = Vector::Zero();
  for (int iteration = 0; iteration < iterations; ++iteration) {
    Eigen::Matrix<double, kUnknowns, kUnknowns> normal = prior.asDiagonal();
    Vector right = Vector::Zero();
    for (const auto& [jacobian, value] : measurements) {
      const double error = (value - jacobian * x).norm() / width;
      const double weight = CauchyWeight(error * error);
      normal += weight * jacobian.transpose() * jacobian;
      right += weight * jacobian.transpose() * value;
    }
    x = normal.ldlt().solve(right);
  }
  return x;
}

}  // namespace evo::tracking
