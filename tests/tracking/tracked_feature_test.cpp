#include "tracking/tracked_feature.hpp"

#include <gtest/gtest.h>

namespace evo::tracking {
namespace {

using Eigen::Vector2d;

TEST(SurfaceEstimate, TakesTheFirstInverseDepthAsMeasured) {
  SurfaceEstimate surface(0.0, Vector2d::Zero());
  surface.UpdateInverseDepth(0.0, 2.0, 7);
  EXPECT_DOUBLE_EQ(surface.inverse_depth(), 2.0);
}

TEST(SurfaceEstimate, AveragesTheFirstFramesEvenlyThenForgets) {
  SurfaceEstimate surface(1.0, Vector2d::Zero());
  surface.UpdateInverseDepth(1.0, 2.0, 2);
  EXPECT_DOUBLE_EQ(surface.inverse_depth(), 1.5);
  surface.UpdateInverseDepth(1.5, 2.5, 1000);
  EXPECT_DOUBLE_EQ(surface.inverse_depth(), 1.75);
}

TEST(SurfaceEstimate, LimitsTheGradientByTheFlow) {
  SurfaceEstimate surface(1.0, Vector2d::Zero());
  surface.CorrectGradient({0.01, 0.0}, 100.0);
  EXPECT_NEAR(surface.gradient().x(), 0.001, 1e-12);
  for (int i = 0; i < 1000; ++i) surface.CorrectGradient({3.0, 4.0}, 10.0);
  EXPECT_NEAR((surface.gradient() - Vector2d(0.006, 0.008)).norm(), 0.0, 1e-6);
}

}  // namespace
}  // namespace evo::tracking
