#include "odometry/scale/plane_smoother.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

namespace evo::odometry {
namespace {

TEST(PlaneSmoother, SolvesLikeADenseSystem) {
  constexpr Eigen::Index kSize = 9;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0.1, 1.0);
  PlaneSmoother smoother(kSize);
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(2 * kSize, 2 * kSize);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(2 * kSize);
  const auto add = [&](const Eigen::VectorXd& J, double value, double weight) {
    normal += weight * J * J.transpose();
    right += weight * value * J;
  };
  for (Eigen::Index node = 0; node + 1 < kSize; ++node) {
    const auto index = static_cast<std::size_t>(node);
    for (int i = 0; i < 3; ++i) {
      const double fraction = uniform(random), value = uniform(random), weight = uniform(random);
      const Eigen::Vector2d row(uniform(random), uniform(random));
      smoother.AddObservation(index, fraction, row, value, weight);
      Eigen::VectorXd J = Eigen::VectorXd::Zero(2 * kSize);
      J.segment<4>(2 * node) << (1.0 - fraction) * row, fraction * row;
      add(J, value, weight);
    }
    const Eigen::Vector2d weights(uniform(random), uniform(random));
    smoother.AddStep(index, weights);
    for (Eigen::Index c = 0; c < 2; ++c) {
      Eigen::VectorXd J = Eigen::VectorXd::Zero(2 * kSize);
      J[2 * node + c] = -1.0;
      J[2 * node + 2 + c] = 1.0;
      add(J, 0.0, weights[c]);
    }
  }
  smoother.AddPrior(3, {0.5, 0.7}, {2.0, 0.0});
  add(Eigen::VectorXd::Unit(2 * kSize, 6), 0.5, 2.0);
  const auto solution = smoother.Solve();
  const Eigen::MatrixXd covariance = normal.inverse();
  const Eigen::VectorXd values = covariance * right;
  for (Eigen::Index i = 0; i < kSize; ++i) {
    const auto index = static_cast<std::size_t>(i);
    EXPECT_NEAR((solution.values[index] - values.segment<2>(2 * i)).norm(), 0.0, 1e-10) << i;
    EXPECT_NEAR((solution.covariances[index] - covariance.block<2, 2>(2 * i, 2 * i)).norm(), 0.0, 1e-10) << i;
  }
}

}  // namespace
}  // namespace evo::odometry
