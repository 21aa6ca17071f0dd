#include "evo/geometry/two_view.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "evo/geometry/triangulation.hpp"

namespace evo::geometry {
namespace {

/// Pairs of a forward-moving, slightly rotating camera; `noise` on the normalized plane z = 1.
std::vector<Correspondence> ForwardDrive(const SE3& T_2_1, int count, double noise, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> side(-0.7, 0.7), depth(4.0, 40.0);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<Correspondence> pairs;
  while (static_cast<int>(pairs.size()) < count) {
    const double z = depth(random);
    const Eigen::Vector3d p1(side(random) * z, 0.5 * side(random) * z, z);
    const Eigen::Vector3d p2 = T_2_1 * p1;
    if (p2.z() < 1.0) continue;
    const auto jitter = [&] { return Eigen::Vector2d(noise * normal(random), noise * normal(random)); };
    pairs.push_back({p1.head<2>() / p1.z() + jitter(), p2.head<2>() / p2.z() + jitter()});
  }
  return pairs;
}

SE3 Motion() { return {so3::Exp({0.01, -0.06, 0.005}), Eigen::Vector3d(0.1, -0.02, -2.0)}; }

double RotationError(const SE3& a, const SE3& b) { return so3::Log(a.rotation() * b.rotation().conjugate()).norm(); }

double DirectionError(const SE3& a, const SE3& b) {
  return std::acos(std::clamp(a.translation().normalized().dot(b.translation().normalized()), -1.0, 1.0));
}

TEST(TwoView, EightPointIsExactWithoutNoise) {
  const auto pairs = ForwardDrive(Motion(), 20, 0.0, 1);
  const auto essential = EightPoint(pairs);
  ASSERT_TRUE(essential);
  for (const auto& pair : pairs) EXPECT_NEAR(SampsonError(*essential, pair), 0.0, 1e-9);
  const Eigen::Matrix3d truth = EssentialMatrix({Motion().rotation(), Motion().translation().normalized()});
  EXPECT_LT(std::min((*essential - truth).norm(), (*essential + truth).norm()), 1e-7);
}

TEST(TwoView, DecompositionContainsTheTrueMotion) {
  const SE3 truth(Motion().rotation(), Motion().translation().normalized());
  double min_error = 10.0;
  for (const SE3& motion : DecomposeEssential(EssentialMatrix(truth))) {
    const Eigen::Matrix3d essential = EssentialMatrix(motion);
    EXPECT_LT(std::min((essential - EssentialMatrix(truth)).norm(), (essential + EssentialMatrix(truth)).norm()), 1e-9);
    min_error = std::min(min_error, (motion.Matrix() - truth.Matrix()).norm());
  }
  EXPECT_LT(min_error, 1e-9);
}

TEST(TwoView, NeedsEightPairs) {
  EXPECT_FALSE(EightPoint(ForwardDrive(Motion(), 7, 0.0, 1)));
  EXPECT_FALSE(EstimateRelativePose(ForwardDrive(Motion(), 7, 0.0, 1), {}));
}

TEST(TwoView, RansacFindsForwardMotionAmongOutliers) {
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    auto pairs = ForwardDrive(Motion(), 80, 0.4 / 226.0, seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> far(-0.2, 0.2);
    for (int i = 0; i < 16; ++i) pairs[5 * i].x2 += Eigen::Vector2d(far(random), far(random));
    const auto pose = EstimateRelativePose(pairs, {.max_sampson_error = 1.5 / 226.0, .seed = seed});
    ASSERT_TRUE(pose) << seed;
    EXPECT_GE(pose->inlier_count, 58) << seed;
    EXPECT_LT(RotationError(pose->T_2_1, Motion()), 0.005) << seed;
    EXPECT_LT(DirectionError(pose->T_2_1, Motion()), 0.04) << seed;
  }
}

TEST(TwoView, ResolvesTheDepthReversalOfNearlyAffineViews) {
  // A narrow lens moves 2 cm sideways past points 0.6 to 1.5 m away: a rotation with all depths reversed fits almost as
  // well as the truth.
  const SE3 truth(Eigen::Quaterniond::Identity(), Eigen::Vector3d(-0.02, 0.0, 0.0));
  int right = 0;
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> x(-0.36, 0.36), y(-0.27, 0.27), depth(0.6, 1.5), outlier(-0.02, 0.02);
    std::normal_distribution<double> noise(0.0, 0.5 / 335.0);
    std::vector<Correspondence> pairs;
    for (int i = 0; i < 90; ++i) {
      const Eigen::Vector3d p = depth(random) * Eigen::Vector3d(x(random), y(random), 1.0);
      const Eigen::Vector3d q = truth * p;
      pairs.push_back({p.head<2>() / p.z() + Eigen::Vector2d(noise(random), noise(random)),
                       q.head<2>() / q.z() + Eigen::Vector2d(noise(random), noise(random))});
      if (i % 7 == 0) pairs.back().x2 += Eigen::Vector2d(outlier(random), outlier(random));
    }
    const auto pose = EstimateRelativePose(pairs, {.max_sampson_error = 1.5 / 335.0, .seed = seed});
    ASSERT_TRUE(pose);
    right += DirectionError(pose->T_2_1, truth) < 0.7 ? 1 : 0;
  }
  EXPECT_GE(right, 19);
}

TEST(TwoView, RefinementLowersTheCostOfTheEightPointStart) {
  double before = 0.0, after = 0.0;
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    const auto pairs = ForwardDrive(Motion(), 60, 0.4 / 226.0, seed);
    double best = 10.0;
    SE3 start;
    for (const SE3& motion : DecomposeEssential(*EightPoint(pairs))) {
      const double error = RotationError(motion, Motion()) + DirectionError(motion, Motion());
      if (error < best) {
        best = error;
        start = motion;
      }
    }
    const SE3 refined = RefineRelativePose(pairs, start);
    before += best;
    after += RotationError(refined, Motion()) + DirectionError(refined, Motion());
    const auto cost = [&](const SE3& motion) {
      double sum = 0.0;
      for (const auto& pair : pairs) sum += std::pow(SampsonError(EssentialMatrix(motion), pair), 2);
      return sum;
    };
    EXPECT_LT(cost(refined), cost({Motion().rotation(), Motion().translation().normalized()})) << seed;
    EXPECT_LT(cost(refined), cost(start)) << seed;
  }
  EXPECT_LT(after, 0.9 * before);
}

TEST(TwoView, RansacIsRepeatable) {
  const auto pairs = ForwardDrive(Motion(), 60, 0.5 / 226.0, 3);
  const auto first = EstimateRelativePose(pairs, {});
  const auto second = EstimateRelativePose(pairs, {});
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->T_2_1.Matrix(), second->T_2_1.Matrix());
}

}  // namespace
}  // namespace evo::geometry
