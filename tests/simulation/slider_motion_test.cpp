#include "simulation/motion/slider_motion.hpp"

#include <gtest/gtest.h>

#include "evo/core/error.hpp"
#include "simulation/velocity_step.hpp"

namespace evo::simulation {
namespace {

TEST(SliderMotion, CoversItsLengthAtConstantSpeed) {
  const PoseFunction motion = MakeSliderMotion({});
  EXPECT_EQ(motion(0).Matrix(), geometry::SE3().Matrix());
  EXPECT_NEAR(motion(FromSeconds(3.0)).translation().x(), 0.6, 1e-12);
  const double speed = 0.6 / 2.95;
  EXPECT_NEAR(motion(FromSeconds(2.0)).translation().x() - motion(FromSeconds(1.0)).translation().x(), speed, 1e-12);
  EXPECT_LT(LargestVelocityStep(motion, 0.0, 3.0).linear, 0.002 * 1.5 * speed / 0.1 * 1.01);
  EXPECT_THROW(MakeSliderMotion({0.05, 1.0}), Error);
}

}  // namespace
}  // namespace evo::simulation
