#include "tracking/motion/robust_linear.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace evo::tracking {
namespace {

using Eigen::Vector3d;

const Vector3d kTruth(1.0, -2.0, 0.5);

/// Measurements of the truth along random directions, every fifth an outlier.
std::vector<LinearMeasurement<1, 3>> Measurements(double outlier) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<LinearMeasurement<1, 3>> measurements;
  for (int i = 0; i < 100; ++i) {
    const Eigen::RowVector3d jacobian(uniform(random), uniform(random), uniform(random));
    Eigen::Matrix<double, 1, 1> value = jacobian * kTruth;
    if (i % 5 == 0) value[0] += outlier;
    measurements.push_back({jacobian, value});
  }
  return measurements;
}

TEST(SolveRobust, SolvesALinearSystem) {
  const Vector3d x = SolveRobust<1, 3>(Measurements(0.0), Vector3d::Zero(), 0.1, 1);
  EXPECT_LT((x - kTruth).norm(), 1e-9);
}

TEST(SolveRobust, OutliersHardlyCount) {
  EXPECT_GT((SolveRobust<1, 3>(Measurements(20.0), Vector3d::Zero(), 1e6, 10) - kTruth).norm(), 1.0);
  EXPECT_LT((SolveRobust<1, 3>(Measurements(20.0), Vector3d::Zero(), 0.1, 30) - kTruth).norm(), 0.01);
}

TEST(SolveRobust, PriorKeepsUnobservedUnknownsAtZero) {
  std::vector<LinearMeasurement<2, 3>> measurements(3);
  for (auto& [jacobian, value] : measurements) {
    jacobian << 1, 0, 0, 0, 1, 0;
    value << 1.0, 2.0;
  }
  const Vector3d x = SolveRobust<2, 3>(measurements, Vector3d::Constant(1e-6), 1.0, 20);
  EXPECT_LT((x - Vector3d(1.0, 2.0, 0.0)).norm(), 1e-4);
}

}  // namespace
}  // namespace evo::tracking
