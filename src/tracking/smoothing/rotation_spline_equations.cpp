#include "tracking/smoothing/rotation_spline_equations.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>

#include "tracking/patch/simd8.hpp"

namespace evo::tracking {

namespace {

constexpr int kTerms = 6;  // of the upper half of a symmetric 3 x 3 block
constexpr std::array<int, kTerms> kRows{0, 0, 0, 1, 1, 2};
constexpr std::array<int, kTerms> kColumns{0, 1, 2, 1, 2, 2};

/// Adds the products of the knots' weights and a block to the blocks of each of `kSplineSpan` knots with the knots
/// after it. As many zeros follow the weights.
EVO_HOT void AddProducts(const std::array<double, 2 * kSplineSpan>& weights, const std::array<double, kTerms>& block,
                         double* terms) {
  for (int i = 0; i < kSplineSpan; ++i) {
    if (weights[i] == 0.0) {
      terms += kTerms * kSplineSpan;
      continue;
    }
    for (const double term : block) {
      const double factor = weights[i] * term;
      for (int d = 0; d < kSplineSpan; ++d) terms[d] += factor * weights[i + d];
      terms += kSplineSpan;
    }
  }
}

}  // namespace

RotationSplineEquations::RotationSplineEquations(std::size_t knots)
    : terms_(knots * kTerms * kSplineSpan, 0.0), right_(knots, Eigen::Vector3d::Zero()) {}

void RotationSplineEquations::Add(const TrackDifference& difference, double weight) {
  const Eigen::Matrix<double, 2, 3> jacobian = difference.jacobian.cast<double>();
  const Eigen::Matrix3d square = weight * jacobian.transpose() * jacobian;
  const Eigen::Vector3d right = weight * jacobian.transpose() * difference.value.cast<double>();
  std::array<double, 2 * kSplineSpan> weights{};
  std::ranges::copy(difference.weights, weights.begin());
  for (int i = 0; i < kSplineSpan; ++i) {
    // There are no weights beyond the last knot.
    if (weights[i] != 0.0) right_[difference.first + i] += weights[i] * right;
  }
  std::array<double, kTerms> block;
  for (int term = 0; term < kTerms; ++term) block[term] = square(kRows[term], kColumns[term]);
  AddProducts(weights, block, terms_.data() + difference.first * kTerms * kSplineSpan);
}

std::vector<Eigen::Vector3d> RotationSplineEquations::Solve(double prior_px) const {
  const auto knots = static_cast<int>(right_.size());
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right(3 * knots);
  for (int i = 0; i < knots; ++i) {
    right.segment<3>(3 * i) = right_[i];
    for (int d = 0; d < kSplineSpan && i + d < knots; ++d) {
      for (int term = 0; term < kTerms; ++term) {
        const int row = kRows[term];
        const int column = kColumns[term];
        const double value = terms_[(i * kTerms + term) * kSplineSpan + d];
        const double prior = d == 0 && row == column ? 1.0 / (prior_px * prior_px) : 0.0;
        entries.emplace_back(3 * (i + d) + column, 3 * i + row, value + prior);
        if (d && row != column) entries.emplace_back(3 * (i + d) + row, 3 * i + column, value);
      }
    }
  }
  Eigen::SparseMatrix<double> lower(3 * knots, 3 * knots);
  lower.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(lower);
  std::vector<Eigen::Vector3d> coefficients(right_.size(), Eigen::Vector3d::Zero());
  if (factors.info() != Eigen::Success) return coefficients;
  const Eigen::VectorXd solution = factors.solve(right);
  for (int i = 0; i < knots; ++i) coefficients[i] = solution.segment<3>(3 * i);
  return coefficients;
}

}  // namespace evo::tracking
