#include "simulation/fast_math.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace evo::simulation {
namespace {

TEST(FastMath, LogIsThatOfTheLibrary) {
  for (float x = 1e-7F; x < 1e7F; x *= 1.0001F) ASSERT_NEAR(FastLog(x), std::log(static_cast<double>(x)), 2e-6) << x;
  for (float x = 0.9F; x < 1.1F; x += 1e-6F) {
    const double exact = std::log(static_cast<double>(x));
    ASSERT_NEAR(FastLog(x), exact, 1e-7 + 1e-6 * std::abs(exact)) << x;
  }
  EXPECT_EQ(FastLog(1.0F), 0.0F);
  EXPECT_NEAR(FastLog(1e-37F), std::log(1e-37), 1e-5);
  EXPECT_NEAR(FastLog(3e38F), std::log(3e38), 1e-5);
}

TEST(FastMath, Log2IsCloseAndContinuous) {
  for (float x = 1e-6F; x < 1e6F; x *= 1.003F) EXPECT_NEAR(FastLog2(x), std::log2(x), 0.011F);
  EXPECT_NEAR(FastLog2(std::nextafter(2.0F, 0.0F)), 1.0F, 1e-5F);
  EXPECT_NEAR(FastLog2(2.0F), 1.0F, 1e-6F);
}

TEST(FastMath, OneMinusExpIsThatOfTheLibrary) {
  EXPECT_EQ(FastOneMinusExp(0.0F), 0.0F);
  for (float x = 1e-30F; x < 100.0F; x *= 1.0003F) {
    const double exact = -std::expm1(-static_cast<double>(x));
    ASSERT_NEAR(FastOneMinusExp(x), exact, 1e-6 * exact) << x;
  }
  EXPECT_EQ(FastOneMinusExp(1e30F), 1.0F);
  EXPECT_EQ(FastOneMinusExp(std::numeric_limits<float>::infinity()), 1.0F);
}

}  // namespace
}  // namespace evo::simulation
