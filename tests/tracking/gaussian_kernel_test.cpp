#include "tracking/patch/gaussian_kernel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

namespace evo::tracking {
namespace {

TEST(GaussianKernel, AddsUpToOneAndFallsLikeAGaussian) {
  for (const double sigma : {0.6, 0.75, 1.0, 2.5}) {
    const std::vector<float> kernel = MakeGaussianKernel(sigma, 20);
    EXPECT_EQ(kernel.size(), 1U + static_cast<std::size_t>(std::ceil(3.0 * sigma)));
    EXPECT_NEAR(2.0f * std::accumulate(kernel.begin(), kernel.end(), 0.0f) - kernel[0], 1.0f, 1e-6f);
    EXPECT_NEAR(kernel[1] / kernel[0], std::exp(-0.5 / (sigma * sigma)), 1e-5);
  }
  EXPECT_EQ(MakeGaussianKernel(2.5, 4).size(), 5U);
}

TEST(GaussianKernel, ConvolvesAlongALine) {
  constexpr std::ptrdiff_t kStep = 2;
  constexpr std::ptrdiff_t kMargin = 20;
  std::vector<float> in(80, 0.0f), out(80, 0.0f);
  in[kMargin + 10] = 3.0f;
  for (const double sigma : {0.5, 0.75, 1.0, 2.0}) {  // of all lengths that have code of their own
    const std::vector<float> kernel = MakeGaussianKernel(sigma, 10);
    ConvolveCells(kernel, in.data() + kMargin, kStep, 32, out.data() + kMargin);
    for (std::ptrdiff_t i = 0; i < 32; ++i) {
      const std::ptrdiff_t distance = std::abs(i - 10);
      const bool reached = distance % kStep == 0 && distance / kStep < static_cast<std::ptrdiff_t>(kernel.size());
      EXPECT_FLOAT_EQ(out[kMargin + i], reached ? 3.0f * kernel[distance / kStep] : 0.0f) << sigma << ", " << i;
    }
  }
}

}  // namespace
}  // namespace evo::tracking
