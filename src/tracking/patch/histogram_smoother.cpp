#include "tracking/patch/histogram_smoother.hpp"

#include <algorithm>

#include "tracking/patch/gaussian_kernel.hpp"
#include "tracking/patch/simd8.hpp"

namespace evo::tracking {

HistogramSmoother::HistogramSmoother(int side, double sigma)
    : side_(side),
      kernel_(MakeGaussianKernel(sigma, side / 2)),
      margin_(static_cast<int>(kernel_.size())),
      width_((side + margin_ + kLanes - 1) / kLanes * kLanes),
      plane_(static_cast<std::size_t>((side + 2 * margin_) * width_)),
      rows_(plane_.size()),
      smooth_(plane_.size()) {}

void HistogramSmoother::Smooth(const float* plane) {
  // A row runs into the next one, but only within the empty margin between them.
  for (int r = 0; r < side_; ++r) std::copy_n(plane + r * side_, side_, plane_.data() + (margin_ + r) * width_);
  const std::ptrdiff_t first = margin_ * width_;
  ConvolveCells(kernel_, plane_.data() + first, 1, side_ * width_, rows_.data() + first);
  ConvolveCells(kernel_, rows_.data() + first, width_, side_ * width_, smooth_.data() + first);
}

}  // namespace evo::tracking
