#include "tracking/motion/depth_samples.hpp"

#include <gtest/gtest.h>

namespace evo::tracking {
namespace {

using Eigen::Vector2d;

const DepthSample kCentre{{100.0, 200.0}, 2.0};
const Vector2d kGradient(0.004, 0.03);

double DepthOnPlane(const Vector2d& position) {
  return kCentre.inverse_depth + kGradient.dot(position - kCentre.position);
}

/// On a grid around the centre and with it.
std::vector<DepthSample> PlaneSamples() {
  std::vector<DepthSample> samples;
  for (int x = -2; x <= 2; ++x) {
    for (int y = -2; y <= 2; ++y) {
      const Vector2d position = kCentre.position + 22.0 * Vector2d(x, y);
      samples.push_back({position, DepthOnPlane(position)});
    }
  }
  return samples;
}

TEST(FitInverseDepthGradient, IsThatOfThePlaneThroughTheSamples) {
  const auto gradient = FitInverseDepthGradient(PlaneSamples(), kCentre);
  ASSERT_TRUE(gradient);
  EXPECT_LT((*gradient - kGradient).norm(), 0.05 * kGradient.norm());
}

TEST(FitInverseDepthGradient, IgnoresOtherSurfacesAndUnknownDepths) {
  auto samples = PlaneSamples();
  for (std::size_t i = 0; i < samples.size(); i += 4) samples[i].inverse_depth = i % 8 ? 0.0 : 7.0;
  const auto gradient = FitInverseDepthGradient(samples, kCentre);
  ASSERT_TRUE(gradient);
  EXPECT_LT((*gradient - kGradient).norm(), 0.1 * kGradient.norm());
}

TEST(FitInverseDepthGradient, IsUnknownWhereTooFewAgree) {
  EXPECT_FALSE(FitInverseDepthGradient({}, kCentre));
  EXPECT_FALSE(FitInverseDepthGradient({kCentre}, kCentre));
  EXPECT_FALSE(FitInverseDepthGradient(PlaneSamples(), {kCentre.position, 0.0}));
  auto samples = PlaneSamples();
  for (auto& sample : samples) sample.position += Vector2d(300.0, 0.0);
  EXPECT_FALSE(FitInverseDepthGradient(samples, kCentre));
}

TEST(MedianInverseDepth, IsTheMedianOfTheNearest) {
  std::vector<DepthSample> samples = {{{0, 0}, 9.0}, {{1, 0}, 1.0}, {{2, 0}, 2.0}, {{0, 3}, 3.0}, {{0, 1}, 0.0}};
  EXPECT_FALSE(MedianInverseDepth(samples, {0, 0})) << "four depths are known";
  for (int x = 10; x < 20; ++x) samples.push_back({{x, 0}, 5.0});
  EXPECT_EQ(MedianInverseDepth(samples, {0, 0}), 3.0) << "of 1, 2, 3, 5 and 9";
  EXPECT_EQ(MedianInverseDepth(samples, {15, 0}), 5.0);
}

}  // namespace
}  // namespace evo::tracking
