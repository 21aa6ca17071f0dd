#include "tracking/gating/outlier_classifier.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace evo::tracking {
namespace {

TEST(OutlierEvidence, ScoresWhatPersists) {
  OutlierEvidence evidence;
  Eigen::Matrix2d shear = Eigen::Matrix2d::Zero();
  shear(0, 1) = 0.02;
  for (int i = 0; i < 10; ++i) {
    const double alternating = i % 2 == 0 ? 1.0 : -1.0;
    evidence.Add({0.3 + alternating, 0.4}, alternating * shear, 0.1);
  }
  EXPECT_EQ(evidence.frames(), 10);
  const OutlierScore score = evidence.Score({5.0, 0.0});  // the epipolar line is parallel to x
  EXPECT_NEAR(score.components[0], 0.4, 1e-12);
  EXPECT_NEAR(score.components[1], 0.0, 1e-12);
  EXPECT_NEAR(score.components[2], 0.1, 1e-12);
  EXPECT_NEAR(evidence.Score({0.0, -0.1}).components[0], 0.3, 1e-12);
  EXPECT_NEAR(evidence.Score({3.0, 4.0}).components[0], 0.0, 1e-12) << "the offset is parallel to this line";
}

TEST(OutlierEvidence, KeepsTheVerdict) {
  OutlierEvidence evidence;
  EXPECT_FALSE(evidence.is_classified());
  evidence.Classify(false);
  EXPECT_TRUE(evidence.is_classified());
  EXPECT_FALSE(evidence.is_rejected());
  evidence.Classify(true);
  EXPECT_TRUE(evidence.is_rejected());
}

OutlierScore TypicalScore(std::mt19937* random) {
  std::exponential_distribution<double> size(1.0);
  return {{0.2 * size(*random), 0.01 * size(*random), 0.05 * size(*random)}};
}

TEST(OutlierClassifier, FindsWhatIsUnusualInAllComponents) {
  std::mt19937 random(5);
  OutlierClassifier classifier(0.05);
  int outliers_found = 0, others = 0, classified = 0;
  for (int frame = 0; frame < 200; ++frame) {
    std::vector<OutlierScore> young;
    for (int i = 0; i < 20; ++i) young.push_back(TypicalScore(&random));
    young[7] = {{1.0, 0.05, 0.25}};  // each component alone has a probability of 1/150
    const std::vector<bool> are_outliers = classifier.Classify(young);
    ASSERT_EQ(are_outliers.size(), young.size());
    if (frame < 5) continue;
    classified += static_cast<int>(young.size());
    outliers_found += are_outliers[7] ? 1 : 0;
    others += static_cast<int>(std::ranges::count(are_outliers, true)) - (are_outliers[7] ? 1 : 0);
  }
  EXPECT_GE(outliers_found, 185);
  EXPECT_LE(others, classified / 50);
}

TEST(OutlierClassifier, RejectsNoneWithFewToCompareWithOrWithRatioZero) {
  std::mt19937 random(5);
  std::vector<OutlierScore> few(20), many;
  for (auto& score : few) score = TypicalScore(&random);
  for (int i = 0; i < 300; ++i) many.push_back(TypicalScore(&random));
  many[3] = {{10.0, 1.0, 1.0}};
  EXPECT_EQ(std::ranges::count(OutlierClassifier(0.2).Classify(few), true), 0);
  EXPECT_EQ(std::ranges::count(OutlierClassifier(0.0).Classify(many), true), 0);
  const std::vector<bool> are_outliers = OutlierClassifier(0.02).Classify(many);
  EXPECT_TRUE(are_outliers[3]);
  EXPECT_EQ(std::ranges::count(are_outliers, true), 6);
  EXPECT_TRUE(OutlierClassifier(0.2).Classify({}).empty());
}

}  // namespace
}  // namespace evo::tracking
