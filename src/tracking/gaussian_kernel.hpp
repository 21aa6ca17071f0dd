#pragma once

#include <cmath>
#include <cstddef>
#include <span>

namespace evo {

/// Cells on either side beyond which a Gaussian is next to nothing; `sigma` in cells.
inline int GaussianReach(double sigma) { return static_cast<int>(std::ceil(3.0 * sigma)); }

/// Fills in a Gaussian's weights for the cells 0, 1, ... away; over both sides they add up to 1.
inline void FillGaussianKernel(double sigma, std::span<float> kernel) {
  float sum = 0.0f;
  for (std::size_t i = 0; i < kernel.size(); ++i) {
    kernel[i] = static_cast<float>(std::exp(-0.5 * static_cast<double>(i * i) / (sigma * sigma)));
    sum += i ? 2.0f * kernel[i] : kernel[i];
  }
  for (float& k : kernel) k /= sum;
}

}  // namespace evo
