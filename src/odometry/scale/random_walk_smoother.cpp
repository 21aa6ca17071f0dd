#include "odometry/scale/random_walk_smoother.hpp"

namespace evo::odometry {

void RandomWalkSmoother::AddObservation(std::size_t node, double fraction, double slope, double value, double weight) {
  const double a = slope * (1.0 - fraction);
  const double b = slope * fraction;
  diagonal_[node] += weight * a * a;
  diagonal_[node + 1] += weight * b * b;
  off_diagonal_[node] += weight * a * b;
  right_side_[node] += weight * a * value;
  right_side_[node + 1] += weight * b * value;
}

void RandomWalkSmoother::AddStep(std::size_t node, double weight) {
  diagonal_[node] += weight;
  diagonal_[node + 1] += weight;
  off_diagonal_[node] -= weight;
}

RandomWalkSmoother::Solution RandomWalkSmoother::Solve() const {
  const std::size_t n = diagonal_.size();
  std::vector<double> forward = diagonal_;   // what remains of the diagonal with all values before eliminated
  std::vector<double> backward = diagonal_;  // the same with all values behind
  Solution solution{right_side_, std::vector<double>(n)};
  std::vector<double>& values = solution.values;
  for (std::size_t i = 1; i < n; ++i) {
    const double factor = off_diagonal_[i - 1] / forward[i - 1];
    forward[i] -= factor * off_diagonal_[i - 1];
    values[i] -= factor * values[i - 1];
  }
  values[n - 1] /= forward[n - 1];
  for (std::size_t i = n - 1; i-- > 0;) {
    backward[i] -= off_diagonal_[i] * off_diagonal_[i] / backward[i + 1];
    values[i] = (values[i] - off_diagonal_[i] * values[i + 1]) / forward[i];
  }
  for (std::size_t i = 0; i < n; ++i) solution.variances[i] = 1.0 / (forward[i] + backward[i] - diagonal_[i]);
  return solution;
}

}  // namespace evo::odometry
