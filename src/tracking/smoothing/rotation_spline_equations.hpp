#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

namespace evo::tracking {

inline constexpr int kSplineSupport = 12;               ///< knots that the longest window depends on
inline constexpr int kSplineSpan = kSplineSupport + 6;  ///< knots that a difference over several frames depends on

/// A finite difference of positions or flows over time, px. It equals the Jacobian times the weighted sum of the
/// coefficients of the knots from `first` on, plus noise.
struct TrackDifference {
  Eigen::Vector2f value = Eigen::Vector2f::Zero();
  Eigen::Matrix<float, 2, 3> jacobian;  ///< of the image point by the rotation, in the middle of the difference
  int first = 0;                        ///< knot
  std::array<float, kSplineSpan> weights{};
};

/// The normal equations of a rotation spline: a band of symmetric 3 x 3 blocks.
class RotationSplineEquations {
 public:
  explicit RotationSplineEquations(std::size_t knots);

  /// `weight`: of the robust loss.
  void Add(const TrackDifference& difference, double weight);
  /// The coefficient of each knot, zero if the equations have no solution. `prior_px`: its standard deviation.
  std::vector<Eigen::Vector3d> Solve(double prior_px) const;

 private:
  std::vector<double> terms_;  // by knot, by term of the upper half of a block, by distance to the other knot
  std::vector<Eigen::Vector3d> right_;
};

}  // namespace evo::tracking
