#include "simulation/motion/handheld_motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulation/velocity_step.hpp"

namespace evo::simulation {
namespace {

TEST(HandheldMotion, StartsAtRestAndHasItsDeviation) {
  HandheldOptions options;
  options.duration_s = 400.0;
  const PoseFunction motion = MakeHandheldMotion(options, 5);
  EXPECT_EQ(motion(0).Matrix(), geometry::SE3().Matrix());
  EXPECT_LT(motion(FromSeconds(0.01)).translation().norm(), 1e-5);
  double translation = 0.0, rotation = 0.0, farthest = 0.0;
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) {
    const geometry::SE3 pose = motion(FromSeconds(2.0 + 0.02 * i));
    translation += pose.translation().squaredNorm() / (3.0 * kSamples);
    rotation += geometry::so3::Log(pose.rotation()).squaredNorm() / (3.0 * kSamples);
    farthest = std::max(farthest, pose.translation().cwiseAbs().maxCoeff());
  }
  EXPECT_NEAR(std::sqrt(translation), 0.3, 0.01);
  EXPECT_NEAR(std::sqrt(rotation) * 180.0 / std::numbers::pi, 12.0, 0.4);
  EXPECT_LT(farthest, 1.2);
  const VelocityStep step = LargestVelocityStep(motion, 0.0, 30.0);
  EXPECT_LT(step.linear, 0.002 * 8.0);
  EXPECT_LT(step.angular, 0.002 * 8.0);
  EXPECT_EQ(motion(FromSeconds(9.0)).Matrix(), MakeHandheldMotion(options, 5)(FromSeconds(9.0)).Matrix());
  EXPECT_NE(motion(FromSeconds(9.0)).Matrix(), MakeHandheldMotion(options, 6)(FromSeconds(9.0)).Matrix());
}

}  // namespace
}  // namespace evo::simulation
