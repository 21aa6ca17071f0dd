#include "odometry/scale/random_walk_smoother.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

namespace evo::odometry {
namespace {

TEST(RandomWalkSmoother, SolvesLikeADenseSystem) {
  constexpr Eigen::Index kSize = 9;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0.1, 1.0);
  RandomWalkSmoother smoother(kSize);
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(kSize, kSize);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(kSize);
  for (Eigen::Index node = 0; node + 1 < kSize; ++node) {
    for (int i = 0; i < 3; ++i) {
      const double fraction = uniform(random), slope = uniform(random), value = uniform(random),
                   weight = uniform(random);
      smoother.AddObservation(static_cast<std::size_t>(node), fraction, slope, value, weight);
      Eigen::VectorXd J = Eigen::VectorXd::Zero(kSize);
      J.segment<2>(node) << slope * (1.0 - fraction), slope * fraction;
      normal += weight * J * J.transpose();
      right += weight * value * J;
    }
    const double weight = uniform(random);
    smoother.AddStep(static_cast<std::size_t>(node), weight);
    Eigen::VectorXd J = Eigen::VectorXd::Zero(kSize);
    J.segment<2>(node) << -1.0, 1.0;
    normal += weight * J * J.transpose();
  }
  const auto solution = smoother.Solve();
  const Eigen::MatrixXd covariance = normal.inverse();
  const Eigen::VectorXd values = covariance * right;
  for (Eigen::Index i = 0; i < kSize; ++i) {
    EXPECT_NEAR(solution.values[static_cast<std::size_t>(i)], values[i], 1e-10) << i;
    EXPECT_NEAR(solution.variances[static_cast<std::size_t>(i)], covariance(i, i), 1e-10) << i;
  }
}

}  // namespace
}  // namespace evo::odometry
