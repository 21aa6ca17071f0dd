#include "evo/tracking/event_density.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "tracking/gaussian_kernel.hpp"

namespace evo {

namespace {

constexpr std::ptrdiff_t kBlock = 8;  // cells computed at a time
using Block = Eigen::Array<float, kBlock, 1>;
using BlockMap = Eigen::Map<const Block>;

/// Whole blocks: the last may reach up to kBlock - 1 cells beyond.
template <std::size_t kSize>
void ConvolveCells(std::span<const float, kSize> kernel, const float* in, std::ptrdiff_t step, std::ptrdiff_t cells,
                   float* out) {
  for (std::ptrdiff_t i = 0; i < cells; i += kBlock) {
    Block sum = kernel[0] * BlockMap(in + i);
    for (std::size_t k = 1; k < kernel.size(); ++k) {
      const std::ptrdiff_t distance = static_cast<std::ptrdiff_t>(k) * step;
      sum += kernel[k] * (BlockMap(in + i - distance) + BlockMap(in + i + distance));
    }
    Eigen::Map<Block>{out + i} = sum;
  }
}

}  // namespace

EventDensity::EventDensity(int radius, int planes, double sigma)
    : radius_(radius),
      planes_(planes),
      half_variance_(static_cast<float>(0.5 * sigma * sigma)),
      longest_pull_(static_cast<float>(kLongestPullSigmas * sigma)),
      kernel_(static_cast<std::size_t>(GaussianReach(sigma)) + 1),
      margin_(std::max<std::ptrdiff_t>(2, static_cast<std::ptrdiff_t>(kernel_.size()) - 1)),
      stride_(2 * radius + 1 + 2 * margin_) {
  FillGaussianKernel(sigma, kernel_);
  plane_cells_ = stride_ * stride_ + kBlock;  // the last block may reach beyond
  votes_.resize(static_cast<std::size_t>(planes_ * plane_cells_));
  rows_.resize(votes_.size());
  smooth_.resize(votes_.size());
}

void EventDensity::Clear() {
  std::ranges::fill(votes_, 0.0f);
  events_ = 0;
}

void EventDensity::Convolve(const std::vector<float>& in, std::ptrdiff_t step, std::vector<float>* out) const {
  // Rows run into one another, but only within the empty margin between them.
  const std::ptrdiff_t first = margin_ * stride_;
  const std::ptrdiff_t cells = (2 * radius_ + 1) * stride_;
  for (int p = 0; p < planes_; ++p) {
    const float* const source = in.data() + p * plane_cells_ + first;
    float* const target = out->data() + p * plane_cells_ + first;
    switch (kernel_.size()) {  // of known length for the usual sigmas, which saves a third
      case 3:
        ConvolveCells(std::span<const float, 3>(kernel_), source, step, cells, target);
        break;
      case 4:
        ConvolveCells(std::span<const float, 4>(kernel_), source, step, cells, target);
        break;
      default:
        ConvolveCells(std::span<const float>(kernel_), source, step, cells, target);
    }
  }
}

void EventDensity::Smooth(double outlier_share) {
  Convolve(votes_, 1, &rows_);
  Convolve(rows_, stride_, &smooth_);
  const int side = 2 * radius_ + 1;
  stray_ = static_cast<float>(std::max(1e-12, outlier_share * events_ / (planes_ * side * side)));
}

}  // namespace evo
