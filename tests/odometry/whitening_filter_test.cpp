#include "odometry/bundle/whitening_filter.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

#include "odometry/track_covariance.hpp"

namespace evo::odometry {
namespace {

/// Magnifications that grow by a factor from observation to observation.
std::vector<double> Magnifications(int observations, double growth) {
  std::vector<double> magnifications;
  for (int k = 0; k < observations; ++k) magnifications.push_back(std::pow(growth, k));
  return magnifications;
}

TEST(WhiteningFilter, InformationIsTheInverseCovariance) {
  for (const double drift : {0.0, 0.05, 2.0}) {
    for (const double growth : {1.0, 1.05, 0.95}) {
      const auto magnifications = Magnifications(25, growth);
      std::vector<WhiteningStep> steps;
      AppendWhiteningSteps(drift, magnifications, &steps);
      Eigen::MatrixXd information;
      ComputeErrorInformation(steps, std::vector<double>(25, 1.0), &information);
      // In units of an innovation's variance in steady state: that of the noise and of the drift.
      const double steady_variance = 0.5 * (drift + std::sqrt(drift * drift + 4.0 * drift));
      const Eigen::MatrixXd expected =
          (1.0 + steady_variance) * testing::TrackCovariance(drift, magnifications).inverse();
      EXPECT_LT((information - expected).cwiseAbs().maxCoeff(), 1e-9) << drift << " " << growth;
    }
  }
}

TEST(WhiteningFilter, InformationIsTheWeightedSumOfSquares) {
  std::vector<WhiteningStep> steps;
  AppendWhiteningSteps(0.3, Magnifications(12, 1.1), &steps);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::vector<Eigen::Vector2d> errors(12), innovations;
  std::vector<double> weights(12);
  Eigen::VectorXd x(12);
  for (int k = 0; k < 12; ++k) {
    errors[k] = {normal(random), normal(random)};
    x[k] = errors[k].x();
    weights[k] = std::abs(normal(random));
  }
  ComputeInnovations(steps, errors, &innovations);
  double expected = 0.0;
  for (int k = 0; k < 12; ++k) expected += weights[k] * innovations[k].x() * innovations[k].x();
  Eigen::MatrixXd information;
  ComputeErrorInformation(steps, weights, &information);
  EXPECT_NEAR(x.dot(information * x), expected, 1e-9 * expected);
}

TEST(WhiteningFilter, InnovationsAreWhite) {
  const double drift_variance_ratio = 0.5;
  const auto magnifications = Magnifications(40, 1.03);
  std::vector<WhiteningStep> steps;
  AppendWhiteningSteps(drift_variance_ratio, magnifications, &steps);
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const int tracks = 2000;
  double early = 0.0, late = 0.0, product = 0.0;
  std::vector<Eigen::Vector2d> errors(40), innovations;
  for (int track = 0; track < tracks; ++track) {
    Eigen::Vector2d drift_px = Eigen::Vector2d::Zero();
    for (int k = 0; k < 40; ++k) {
      errors[k] = magnifications[k] * drift_px + Eigen::Vector2d(normal(random), normal(random));
      drift_px += std::sqrt(drift_variance_ratio) / magnifications[k] * Eigen::Vector2d(normal(random), normal(random));
    }
    ComputeInnovations(steps, errors, &innovations);
    early += innovations[1].squaredNorm() / (2 * tracks);
    late += innovations[39].squaredNorm() / (2 * tracks);
    product += innovations[38].dot(innovations[39]) / (2 * tracks);
  }
  EXPECT_NEAR(late / early, 1.0, 0.08);
  EXPECT_NEAR(product / late, 0.0, 0.05);
}

}  // namespace
}  // namespace evo::odometry
