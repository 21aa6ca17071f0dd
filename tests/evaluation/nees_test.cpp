#include "evaluation/trajectory/nees.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace evo::evaluation {
namespace {

constexpr double kPositionSigma = 0.03;
constexpr double kAngleSigma = 0.002;

struct NoisyRun {
  std::vector<PosePair> pairs;
  std::vector<geometry::StampedCovariance> covariances;
};

/// Errors drawn from the covariances; the first pose is the origin and has none.
NoisyRun MakeRun(int poses, double scale, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const geometry::SE3 T_estimate_truth(geometry::so3::Exp({0.4, -1.0, 0.7}), {3.0, -2.0, 5.0});
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();
  covariance.diagonal() << Eigen::Vector3d::Constant(kPositionSigma * kPositionSigma),
      Eigen::Vector3d::Constant(kAngleSigma * kAngleSigma);
  NoisyRun run;
  for (int i = 0; i < poses; ++i) {
    const TimeNs t = i * TimeNs{20'000'000};
    const geometry::SE3 truth(geometry::so3::Exp({0.0, 0.01 * i, 0.0}), {0.2 * i, std::sin(0.1 * i), 0.05 * i});
    const geometry::SE3 turned = T_estimate_truth * truth;
    const double size = i == 0 ? 0.0 : 1.0;
    const auto draw = [&](double sigma) -> Eigen::Vector3d {
      return size * sigma * Eigen::Vector3d(normal(random), normal(random), normal(random));
    };
    const geometry::SE3 estimate(geometry::so3::Exp(draw(kAngleSigma)) * turned.rotation(),
                                 scale * turned.translation() + draw(kPositionSigma));
    run.pairs.push_back({t, t, estimate, truth});
    run.covariances.push_back({t, size * covariance});
  }
  return run;
}

TEST(Nees, IsOneForConsistentCovariances) {
  const NoisyRun run = MakeRun(3000, 0.4, 1);
  const auto nees = ComputeNees(run.pairs, run.covariances, true);
  EXPECT_EQ(nees.pose.count, 2999) << "the origin does not count";
  // The squared error of n degrees of freedom over n has the variance 2 / n.
  EXPECT_NEAR(nees.translation.mean, 1.0, 4.0 * std::sqrt(2.0 / 3.0 / 2999.0));
  EXPECT_NEAR(nees.rotation.mean, 1.0, 4.0 * std::sqrt(2.0 / 3.0 / 2999.0));
  EXPECT_NEAR(nees.pose.mean, 1.0, 4.0 * std::sqrt(2.0 / 6.0 / 2999.0));
}

TEST(Nees, ScalesWithTheInverseCovariance) {
  NoisyRun run = MakeRun(500, 1.0, 2);
  const double consistent = ComputeNees(run.pairs, run.covariances, true).pose.mean;
  for (auto& row : run.covariances) row.covariance /= 9.0;
  EXPECT_NEAR(ComputeNees(run.pairs, run.covariances, true).pose.mean, 9.0 * consistent, 1e-9);
}

TEST(Nees, IncludesTheScaleErrorIfTheScaleIsFixed) {
  const NoisyRun run = MakeRun(500, 1.01, 3);
  EXPECT_LT(ComputeNees(run.pairs, run.covariances, true).translation.mean, 1.3);
  EXPECT_GT(ComputeNees(run.pairs, run.covariances, false).translation.mean, 10.0);
}

TEST(Nees, EveryReinitialisationHasItsOwnOrigin) {
  const NoisyRun first = MakeRun(400, 0.4, 5);
  NoisyRun second = MakeRun(400, 1.7, 6);  // another scale
  NoisyRun both = first;
  for (std::size_t i = 0; i < second.pairs.size(); ++i) {
    const TimeNs later = second.covariances[i].t + 400 * TimeNs{20'000'000};
    second.pairs[i].t_estimate = second.pairs[i].t_truth = second.covariances[i].t = later;
    both.pairs.push_back(second.pairs[i]);
    both.covariances.push_back(second.covariances[i]);
  }
  const auto nees = ComputeNees(both.pairs, both.covariances, true);
  EXPECT_EQ(nees.pose.count, 798);
  EXPECT_NEAR(nees.pose.mean, 1.0, 0.2);
}

TEST(Nees, SkipsPosesWithoutCovariance) {
  NoisyRun run = MakeRun(100, 1.0, 4);
  std::erase_if(run.covariances, [](const geometry::StampedCovariance& row) { return row.t % 40'000'000 != 0; });
  EXPECT_EQ(ComputeNees(run.pairs, run.covariances, true).pose.count, 49);
  run.covariances.erase(run.covariances.begin());
  EXPECT_EQ(ComputeNees(run.pairs, run.covariances, true).pose.count, 0) << "there is no origin";
  const auto none = ComputeNees(run.pairs, {}, true);
  EXPECT_EQ(none.pose.count, 0);
  EXPECT_TRUE(std::isnan(none.pose.mean));
}

}  // namespace
}  // namespace evo::evaluation
