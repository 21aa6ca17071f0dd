#include "odometry/bundle/track_noise.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

#include "odometry/track_covariance.hpp"

namespace evo::odometry {
namespace {

std::vector<double> Growing(int sightings, double growth) {
  std::vector<double> magnifications;
  for (int k = 0; k < sightings; ++k) magnifications.push_back(std::pow(growth, k));
  return magnifications;
}

TEST(TrackNoise, InformationIsTheInverseCovariance) {
  for (const double drift : {0.0, 0.05, 2.0}) {
    for (const double growth : {1.0, 1.05, 0.95}) {
      const auto magnifications = Growing(25, growth);
      std::vector<InnovationStep> steps;
      AppendInnovationSteps(drift, magnifications, &steps);
      Eigen::MatrixXd information;
      InformationOfErrors(steps, std::vector<double>(25, 1.0), &information);
      // In units of the variance that an innovation has in the long run: that of the noise and of the settled drift.
      const double settled = 0.5 * (drift + std::sqrt(drift * drift + 4.0 * drift));
      const Eigen::MatrixXd expected = (1.0 + settled) * testing::TrackCovariance(drift, magnifications).inverse();
      EXPECT_LT((information - expected).cwiseAbs().maxCoeff(), 1e-9) << drift << " " << growth;
    }
  }
}

TEST(TrackNoise, InformationWeighsTheInnovations) {
  std::vector<InnovationStep> steps;
  AppendInnovationSteps(0.3, Growing(12, 1.1), &steps);
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
  Innovate(steps, errors, &innovations);
  double expected = 0.0;
  for (int k = 0; k < 12; ++k) expected += weights[k] * innovations[k].x() * innovations[k].x();
  Eigen::MatrixXd information;
  InformationOfErrors(steps, weights, &information);
  EXPECT_NEAR(x.dot(information * x), expected, 1e-9 * expected);
}

TEST(TrackNoise, InnovationsAreIndependentAndOfOneSize) {
  const double drift = 0.5;
  const auto magnifications = Growing(40, 1.03);
  std::vector<InnovationStep> steps;
  AppendInnovationSteps(drift, magnifications, &steps);
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const int tracks = 2000;
  double early = 0.0, late = 0.0, product = 0.0;
  std::vector<Eigen::Vector2d> errors(40), innovations;
  for (int track = 0; track < tracks; ++track) {
    Eigen::Vector2d slid = Eigen::Vector2d::Zero();
    for (int k = 0; k < 40; ++k) {
      errors[k] = magnifications[k] * slid + Eigen::Vector2d(normal(random), normal(random));
      slid += std::sqrt(drift) / magnifications[k] * Eigen::Vector2d(normal(random), normal(random));
    }
    Innovate(steps, errors, &innovations);
    early += innovations[1].squaredNorm() / (2 * tracks);
    late += innovations[39].squaredNorm() / (2 * tracks);
    product += innovations[38].dot(innovations[39]) / (2 * tracks);
  }
  EXPECT_NEAR(late / early, 1.0, 0.08);
  EXPECT_NEAR(product / late, 0.0, 0.05);
}

}  // namespace
}  // namespace evo::odometry
