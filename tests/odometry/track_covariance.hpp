#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

namespace evo::odometry::testing {

/// What errors with that drift and unit noise vary and covary like, one coordinate.
inline Eigen::MatrixXd TrackCovariance(double drift, const std::vector<double>& magnifications) {
  const auto n = static_cast<Eigen::Index>(magnifications.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      for (Eigen::Index k = 0; k < std::min(i, j); ++k) {
        const double step = 1.0 / magnifications[static_cast<std::size_t>(k)];
        covariance(i, j) += drift * step * step * magnifications[static_cast<std::size_t>(i)] *
                            magnifications[static_cast<std::size_t>(j)];
      }
    }
  }
  return covariance;
}

}  // namespace evo::odometry::testing
