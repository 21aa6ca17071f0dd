#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace evo::odometry {

/// Least squares over a chain of planes, each connected to its neighbours only, as in the smoothing of a random walk: a
/// symmetric block-tridiagonal system. A plane is its inverse height below the path and, times that, its roll. At least
/// one plane.
class PlaneSmoother {
 public:
  explicit PlaneSmoother(std::size_t size)
      : diagonal_(size, Eigen::Matrix2d::Zero()),
        off_diagonal_(diagonal_),
        right_side_(size, Eigen::Vector2d::Zero()) {}

  /// Adds the observation row . ((1 - fraction) * x[node] + fraction * x[node + 1]) = value.
  void AddObservation(std::size_t node, double fraction, const Eigen::Vector2d& row, double value, double weight);
  /// Adds x[node + 1] - x[node] = 0 with a weight for each component.
  void AddStep(std::size_t node, const Eigen::Vector2d& weights);
  /// Adds x[node] = value with a weight for each component.
  void AddPrior(std::size_t node, const Eigen::Vector2d& value, const Eigen::Vector2d& weights);

  struct Solution {
    std::vector<Eigen::Vector2d> values;
    std::vector<Eigen::Matrix2d> covariances;  ///< diagonal blocks of the inverse
  };
  /// By elimination from both ends (Thomas's algorithm).
  Solution Solve() const;

 private:
  std::vector<Eigen::Matrix2d> diagonal_;
  std::vector<Eigen::Matrix2d> off_diagonal_;  // between each plane and the next
  std::vector<Eigen::Vector2d> right_side_;
};

}  // namespace evo::odometry
