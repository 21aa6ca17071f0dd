#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

namespace evo::odometry::testing {

/// Covariance of one coordinate of a track's errors with unit white noise and this drift, see WhiteningStep.
inline Eigen::MatrixXd TrackCovariance(double drift_variance_ratio, const std::vector<double>& magnifications) {
  const auto n = static_cast<Eigen::Index>(magnifications.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      for (Eigen::Index k = 0; k < std::min(i, j); ++k) {
        const double step = 1.0 / magnifications[static_cast<std::size_t>(k)];
        covariance(i, j) += drift_variance_ratio * step * step * magnifications[static_cast<std::size_t>(i)] *
                            magnifications[static_cast<std::size_t>(j)];
      }
    }
  }
  return covariance;
}

}  // namespace evo::odometry::testing
