#include "tracking/gating/oddity.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace evo::tracking {
namespace {

TEST(OddityMeans, AreOfWhatPersists) {
  OddityMeans means;
  Eigen::Matrix2d shear = Eigen::Matrix2d::Zero();
  shear(0, 1) = 0.02;
  for (int i = 0; i < 10; ++i) {
    const double back_and_forth = i % 2 == 0 ? 1.0 : -1.0;
    means.Add({0.3 + back_and_forth, 0.4}, back_and_forth * shear, 0.1);
  }
  EXPECT_EQ(means.frames(), 10);
  const Oddity oddity = means.Of({5.0, 0.0});  // points move along x, so y is across
  EXPECT_NEAR(oddity.sizes[0], 0.4, 1e-12);
  EXPECT_NEAR(oddity.sizes[1], 0.0, 1e-12);
  EXPECT_NEAR(oddity.sizes[2], 0.1, 1e-12);
  EXPECT_NEAR(means.Of({0.0, -0.1}).sizes[0], 0.3, 1e-12);
  EXPECT_NEAR(means.Of({3.0, 4.0}).sizes[0], 0.0, 1e-12) << "all of it is along";
}

Oddity Usual(std::mt19937* random) {
  std::exponential_distribution<double> size(1.0);
  return {{0.2 * size(*random), 0.01 * size(*random), 0.05 * size(*random)}};
}

TEST(OddityJudge, FindsWhatIsUnusualInAllRespects) {
  std::mt19937 random(5);
  OddityJudge judge(0.05);
  int odd_found = 0, others = 0, judged = 0;
  for (int frame = 0; frame < 200; ++frame) {
    std::vector<Oddity> young;
    for (int i = 0; i < 20; ++i) young.push_back(Usual(&random));
    young[7] = {{1.0, 0.05, 0.25}};  // each by itself is seen in one of 150
    const std::vector<bool> are_odd = judge.AreOdd(young);
    ASSERT_EQ(are_odd.size(), young.size());
    if (frame < 5) continue;
    judged += static_cast<int>(young.size());
    odd_found += are_odd[7] ? 1 : 0;
    others += static_cast<int>(std::ranges::count(are_odd, true)) - (are_odd[7] ? 1 : 0);
  }
  EXPECT_GE(odd_found, 185);
  EXPECT_LE(others, judged / 50);
}

TEST(OddityJudge, JudgesNobodyWithFewToCompareWithOrWithoutAShare) {
  std::mt19937 random(5);
  std::vector<Oddity> few(20), many;
  for (auto& oddity : few) oddity = Usual(&random);
  for (int i = 0; i < 300; ++i) many.push_back(Usual(&random));
  many[3] = {{10.0, 1.0, 1.0}};
  EXPECT_EQ(std::ranges::count(OddityJudge(0.2).AreOdd(few), true), 0);
  EXPECT_EQ(std::ranges::count(OddityJudge(0.0).AreOdd(many), true), 0);
  const std::vector<bool> are_odd = OddityJudge(0.02).AreOdd(many);
  EXPECT_TRUE(are_odd[3]);
  EXPECT_EQ(std::ranges::count(are_odd, true), 6);
  EXPECT_TRUE(OddityJudge(0.2).AreOdd({}).empty());
}

}  // namespace
}  // namespace evo::tracking
