#include "evo/evaluation/consistency.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace evo::evaluation {
namespace {

constexpr double kPositionSigma = 0.03;
constexpr double kAngleSigma = 0.002;

struct Noisy {
  std::vector<PosePair> pairs;
  std::vector<geometry::StampedCovariance> covariances;
};

/// Errors as large as the covariances say, but for the first pose, which has none.
Noisy MakeRun(int poses, double scale, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const geometry::SE3 T_estimate_truth(geometry::so3::Exp({0.4, -1.0, 0.7}), {3.0, -2.0, 5.0});
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();
  covariance.diagonal() << Eigen::Vector3d::Constant(kPositionSigma * kPositionSigma),
      Eigen::Vector3d::Constant(kAngleSigma * kAngleSigma);
  Noisy run;
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

TEST(Consistency, IsOneWhereErrorsAreAsLargeAsSaid) {
  const Noisy run = MakeRun(3000, 0.4, 1);
  const auto consistency = MeasureConsistency(run.pairs, run.covariances, true);
  EXPECT_EQ(consistency.pose.count, 2999) << "the certain pose does not count";
  // The squared error of n degrees of freedom over n has the variance 2 / n.
  EXPECT_NEAR(consistency.translation.mean, 1.0, 4.0 * std::sqrt(2.0 / 3.0 / 2999.0));
  EXPECT_NEAR(consistency.rotation.mean, 1.0, 4.0 * std::sqrt(2.0 / 3.0 / 2999.0));
  EXPECT_NEAR(consistency.pose.mean, 1.0, 4.0 * std::sqrt(2.0 / 6.0 / 2999.0));
}

TEST(Consistency, GrowsAsTheErrorsSquareOverTheCovariance) {
  Noisy run = MakeRun(500, 1.0, 2);
  const double honest = MeasureConsistency(run.pairs, run.covariances, true).pose.mean;
  for (auto& row : run.covariances) row.covariance /= 9.0;
  EXPECT_NEAR(MeasureConsistency(run.pairs, run.covariances, true).pose.mean, 9.0 * honest, 1e-9);
}

TEST(Consistency, AFixedScaleIsJudgedToo) {
  const Noisy run = MakeRun(500, 1.01, 3);
  EXPECT_LT(MeasureConsistency(run.pairs, run.covariances, true).translation.mean, 1.3);
  EXPECT_GT(MeasureConsistency(run.pairs, run.covariances, false).translation.mean, 10.0);
}

TEST(Consistency, ARunThatWasStartedAnewIsJudgedPieceByPiece) {
  const Noisy first = MakeRun(400, 0.4, 5);
  Noisy second = MakeRun(400, 1.7, 6);  // another scale
  Noisy both = first;
  for (std::size_t i = 0; i < second.pairs.size(); ++i) {
    const TimeNs later = second.covariances[i].t + 400 * TimeNs{20'000'000};
    second.pairs[i].t_estimate = second.pairs[i].t_truth = second.covariances[i].t = later;
    both.pairs.push_back(second.pairs[i]);
    both.covariances.push_back(second.covariances[i]);
  }
  const auto consistency = MeasureConsistency(both.pairs, both.covariances, true);
  EXPECT_EQ(consistency.pose.count, 798);
  EXPECT_NEAR(consistency.pose.mean, 1.0, 0.2);
}

TEST(Consistency, PosesWithoutACovarianceDoNotCount) {
  Noisy run = MakeRun(100, 1.0, 4);
  std::erase_if(run.covariances, [](const geometry::StampedCovariance& row) { return row.t % 40'000'000 != 0; });
  EXPECT_EQ(MeasureConsistency(run.pairs, run.covariances, true).pose.count, 49);
  run.covariances.erase(run.covariances.begin());
  EXPECT_EQ(MeasureConsistency(run.pairs, run.covariances, true).pose.count, 0) << "relative to what?";
  const auto none = MeasureConsistency(run.pairs, {}, true);
  EXPECT_EQ(none.pose.count, 0);
  EXPECT_TRUE(std::isnan(none.pose.mean));
}

}  // namespace
}  // namespace evo::evaluation
