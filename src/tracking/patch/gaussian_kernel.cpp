#include "tracking/patch/gaussian_kernel.hpp"

#include "tracking/patch/lanes.hpp"

namespace evo::tracking {

namespace {

template <std::size_t kSize>
EVO_INLINE void Convolve(std::span<const float, kSize> kernel, const float* in, std::ptrdiff_t step,
                         std::ptrdiff_t cells, float* out) {
  for (std::ptrdiff_t i = 0; i < cells; i += kLanes) {
    Lanes sum, before, after;
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

void FillGaussianKernel(double sigma, std::span<float> kernel) {
  float sum = 0.0f;
  for (std::size_t i = 0; i < kernel.size(); ++i) {
    kernel[i] = static_cast<float>(std::exp(-0.5 * static_cast<double>(i * i) / (sigma * sigma)));
    sum += i ? 2.0f * kernel[i] : kernel[i];
  }
  for (float& k : kernel) k /= sum;
}

EVO_HOT void ConvolveCells(std::span<const float> kernel, const float* in, std::ptrdiff_t step, std::ptrdiff_t cells,
                           float* out) {
  switch (kernel.size()) {  // of known length for the usual sigmas, which saves a third
    case 3:
      return Convolve(std::span<const float, 3>(kernel), in, step, cells, out);
    case 4:
      return Convolve(std::span<const float, 4>(kernel), in, step, cells, out);
    default:
      return Convolve(kernel, in, step, cells, out);
  }
}

}  // namespace evo::tracking
