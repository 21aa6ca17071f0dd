#include "odometry/scale/plane_smoother.hpp"

#include <Eigen/LU>

namespace evo::odometry {

void PlaneSmoother::AddObservation(std::size_t node, double fraction, const Eigen::Vector2d& row, double value,
                                   double weight) {
  const Eigen::Vector2d a = (1.0 - fraction) * row;
  const Eigen::Vector2d b = fraction * row;
  diagonal_[node] += weight * a * a.transpose();
  diagonal_[node + 1] += weight * b * b.transpose();
  off_diagonal_[node] += weight * a * b.transpose();
  right_side_[node] += weight * value * a;
  right_side_[node + 1] += weight * value * b;
}

void PlaneSmoother::AddStep(std::size_t node, const Eigen::Vector2d& weights) {
  diagonal_[node] += weights.asDiagonal();
  diagonal_[node + 1] += weights.asDiagonal();
  off_diagonal_[node] -= weights.asDiagonal();
}

void PlaneSmoother::AddPrior(std::size_t node, const Eigen::Vector2d& value, const Eigen::Vector2d& weights) {
  diagonal_[node] += weights.asDiagonal();
  right_side_[node] += weights.cwiseProduct(value);
}

PlaneSmoother::Solution PlaneSmoother::Solve() const {
  const std::size_t n = diagonal_.size();
  std::vector<Eigen::Matrix2d> forward = diagonal_;   // what remains of the diagonal with all planes before eliminated
  std::vector<Eigen::Matrix2d> backward = diagonal_;  // the same with all planes behind
  Solution solution{right_side_, std::vector<Eigen::Matrix2d>(n)};
  std::vector<Eigen::Vector2d>& values = solution.values;
  for (std::size_t i = 1; i < n; ++i) {
    const Eigen::Matrix2d factor = off_diagonal_[i - 1].transpose() * forward[i - 1].inverse();
    forward[i] -= factor * off_diagonal_[i - 1];
    values[i] -= factor * values[i - 1];
  }
  values[n - 1] = forward[n - 1].inverse() * values[n - 1];
  for (std::size_t i = n - 1; i-- > 0;) {
    backward[i] -= off_diagonal_[i] * backward[i + 1].inverse() * off_diagonal_[i].transpose();
    values[i] = forward[i].inverse() * (values[i] - off_diagonal_[i] * values[i + 1]);
  }
  for (std::size_t i = 0; i < n; ++i) {
    solution.covariances[i] = (forward[i] + backward[i] - diagonal_[i]).inverse();
  }
  return solution;
}

}  // namespace evo::odometry
