#pragma once

#include <cstddef>
#include <vector>

namespace evo::odometry {

/// Least squares over a chain of values, each connected to its neighbours only, as in the smoothing of a random walk: a
/// symmetric tridiagonal system. At least one value.
class RandomWalkSmoother {
 public:
  explicit RandomWalkSmoother(std::size_t size) : diagonal_(size), off_diagonal_(size), right_side_(size) {}

  /// Adds the observation slope * ((1 - fraction) * x[node] + fraction * x[node + 1]) = value.
  void AddObservation(std::size_t node, double fraction, double slope, double value, double weight);
  /// Adds x[node + 1] - x[node] = 0.
  void AddStep(std::size_t node, double weight);

  struct Solution {
    std::vector<double> values;
    std::vector<double> variances;  ///< diagonal of the inverse
  };
  /// By elimination from both ends (Thomas's algorithm).
  Solution Solve() const;

 private:
  std::vector<double> diagonal_;
  std::vector<double> off_diagonal_;  // between each value and the next
  std::vector<double> right_side_;
};

}  // namespace evo::odometry
