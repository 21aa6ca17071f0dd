#include "evo/core/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace evo {
namespace {

TEST(Random, HasTheMomentsOfItsDistributions) {
  Random random(7);
  constexpr int kDraws = 200'000;
  double uniform = 0.0, normal = 0.0, normal2 = 0.0, exponential = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const double u = random.Uniform();
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    uniform += u / kDraws;
    const double n = random.Normal();
    normal += n / kDraws;
    normal2 += n * n / kDraws;
    exponential += random.Exponential() / kDraws;
  }
  EXPECT_NEAR(uniform, 0.5, 0.003);
  EXPECT_NEAR(normal, 0.0, 0.01);
  EXPECT_NEAR(normal2, 1.0, 0.015);
  EXPECT_NEAR(exponential, 1.0, 0.01);
}

TEST(Random, StreamsAreRepeatableAndUnrelated) {
  EXPECT_EQ(Random(1, 2).Bits(), Random(1, 2).Bits());
  double product = 0.0;
  constexpr int kStreams = 100'000;
  for (int i = 0; i < kStreams; ++i) {
    product += (Random(1, i).Uniform() - 0.5) * (Random(1, i + 1).Uniform() - 0.5) / kStreams;
  }
  EXPECT_NEAR(product * 12.0, 0.0, 0.02) << "correlation of neighbouring streams";
}

}  // namespace
}  // namespace evo
