#include "tracking/patch/gaussian_kernel.hpp"

#include <algorithm>
#include <cmath>

#include "tracking/patch/simd8.hpp"

namespace evo::tracking {

namespace {

constexpr double kRadiusSigmas = 3.0;  // 99.7 % of a Gaussian

template <std::size_t kSize>
EVO_INLINE void Convolve(std::span<const float, kSize> kernel, const float* in, std::ptrdiff_t step,
                         std::ptrdiff_t cells, float* out) {
  for (std::ptrdiff_t i = 0; i < cells; i += kLanes) {
    F32x8 sum, before, after;
    Load(in + i, &sum);
    sum *= kernel[0];
    for (std::size_t k = 1; k < kernel.size(); ++k) {
      const std::ptrdiff_t distance = static_cast<std::ptrdiff_t>(k) * step;
      Load(in + i - distance, &before);
      Load(in + i + distance, &after);
      sum += kernel[k] * (before + after);
    }
    Store(sum, out + i);
  }
}

}  // namespace

std::vector<float> MakeGaussianKernel(double sigma, int max_radius) {
  const int radius = std::min(max_radius, static_cast<int>(std::ceil(kRadiusSigmas * sigma)));
  std::vector<float> kernel(static_cast<std::size_t>(radius) + 1);
  float sum = 0.0f;
  for (std::size_t i = 0; i < kernel.size(); ++i) {
    kernel[i] = static_cast<float>(std::exp(-0.5 * static_cast<double>(i * i) / (sigma * sigma)));
    sum += i ? 2.0f * kernel[i] : kernel[i];
  }
  for (float& k : kernel) k /= sum;
  return kernel;
}

EVO_HOT void ConvolveCells(std::span<const float> kernel, const float* in, std::ptrdiff_t step, std::ptrdiff_t cells,
                           float* out) {
  switch (kernel.size()) {  // a length known to the compiler, as of the default sigmas, saves a third
    case 3:
      return Convolve(std::span<const float, 3>(kernel), in, step, cells, out);
    case 4:
      return Convolve(std::span<const float, 4>(kernel), in, step, cells, out);
    default:
      return Convolve(kernel, in, step, cells, out);
  }
}

}  // namespace evo::tracking
