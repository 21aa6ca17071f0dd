#include "tracking/detection/harris.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace evo::tracking {

namespace {

constexpr float kHarrisK = 0.04f;  // of Harris and Stephens
// Of sigma 1 px. Constants for the compiler; MakeGaussianKernel(1, 3) differs in the last bit of the last weight.
constexpr std::array<float, 4> kGaussian = {0.39905028f, 0.24203623f, 0.05400558f, 0.00443305f};
constexpr int kSmoothReach = 3;
constexpr int kGradientReach = kSmoothReach + 1;
constexpr int kStripeRows = 16;  // that a thread takes at a time

/// Calls `work` for each row of [margin, height - margin).
template <typename Work>
void ForEachRow(int height, int margin, ThreadPool* pool, const Work& work) {
  const int stripes = std::max(0, height - 2 * margin + kStripeRows - 1) / kStripeRows;
  pool->ForEach(static_cast<std::size_t>(stripes), [&](std::size_t stripe) {
    const int begin = margin + static_cast<int>(stripe) * kStripeRows;
    const int end = std::min(begin + kStripeRows, height - margin);
    for (int y = begin; y < end; ++y) work(y);
  });
}

// The loops are functions of plain pointers, which the compiler vectorises.

/// Products of the Sobel gradients of the middle one of three rows, which are `stride` apart, at x in [begin, end).
void MultiplyGradients(const float* in, std::ptrdiff_t stride, std::ptrdiff_t begin, std::ptrdiff_t end,
                       float* __restrict xx, float* __restrict xy, float* __restrict yy) {
  const float* const above = in - stride;
  const float* const below = in + stride;
  for (std::ptrdiff_t x = begin; x < end; ++x) {
    const float dx = above[x + 1] - above[x - 1] + 2.0f * (in[x + 1] - in[x - 1]) + below[x + 1] - below[x - 1];
    const float dy = below[x - 1] - above[x - 1] + 2.0f * (below[x] - above[x]) + below[x + 1] - above[x + 1];
    xx[x] = dx * dx;
    xy[x] = dx * dy;
    yy[x] = dy * dy;
  }
}

/// Sums of the seven elements around each x in [begin, end), `step` apart.
void SumSevens(const float* in, std::ptrdiff_t step, std::ptrdiff_t begin, std::ptrdiff_t end, float* __restrict out) {
  for (std::ptrdiff_t x = begin; x < end; ++x) {
    out[x] =
        in[x - 3 * step] + in[x - 2 * step] + in[x - step] + in[x] + in[x + step] + in[x + 2 * step] + in[x + 3 * step];
  }
}

void ToResponse(const float* xx, const float* xy, const float* yy, std::ptrdiff_t begin, std::ptrdiff_t end,
                float* __restrict out) {
  for (std::ptrdiff_t x = begin; x < end; ++x) {
    const float trace = xx[x] + yy[x];
    out[x] = xx[x] * yy[x] - xy[x] * xy[x] - kHarrisK * trace * trace;
  }
}

}  // namespace

void Harris::Respond(const cv::Mat& image, ThreadPool* pool) {
  const auto cells = static_cast<std::size_t>(image.cols) * static_cast<std::size_t>(image.rows);
  if (width_ != image.cols || response_.size() != cells) {
    width_ = image.cols;
    for (Plane* plane : {&rows_, &smooth_, &sums_[0], &sums_[1], &sums_[2], &response_}) plane->assign(cells, 0.0f);
  }
  ForEachRow(image.rows, 0, pool, [&](int y) { SmoothAlongRow(image.ptr<float>(y), y); });
  ForEachRow(image.rows, kSmoothReach, pool, [&](int y) { SmoothAlongColumn(y); });
  ForEachRow(image.rows, kGradientReach, pool, [&](int y) { SumGradientsAlongRow(y); });
  ForEachRow(image.rows, kBorderPx, pool, [&](int y) { RespondAlongRow(y); });
}

void Harris::SmoothAlongRow(const float* image, int y) {
  thread_local Plane root;
  root.resize(static_cast<std::size_t>(width_));
  for (std::ptrdiff_t x = 0; x < width_; ++x) root[x] = std::sqrt(image[x]);
  const float* const in = root.data();
  float* __restrict const out = rows_.data() + y * width_;
  for (std::ptrdiff_t x = kSmoothReach; x < width_ - kSmoothReach; ++x) {
    out[x] = kGaussian[0] * in[x] + kGaussian[1] * (in[x - 1] + in[x + 1]) + kGaussian[2] * (in[x - 2] + in[x + 2]) +
             kGaussian[3] * (in[x - 3] + in[x + 3]);
  }
}

void Harris::SmoothAlongColumn(int y) {
  const std::ptrdiff_t w = width_;
  const float* const in = rows_.data() + y * w;
  float* __restrict const out = smooth_.data() + y * w;
  for (std::ptrdiff_t x = kSmoothReach; x < w - kSmoothReach; ++x) {
    out[x] = kGaussian[0] * in[x] + kGaussian[1] * (in[x - w] + in[x + w]) +
             kGaussian[2] * (in[x - 2 * w] + in[x + 2 * w]) + kGaussian[3] * (in[x - 3 * w] + in[x + 3 * w]);
  }
}

void Harris::SumGradientsAlongRow(int y) {
  thread_local std::array<Plane, 3> products;
  for (Plane& product : products) product.resize(static_cast<std::size_t>(width_));
  const float* const in = smooth_.data() + y * width_;
  MultiplyGradients(in, width_, kGradientReach, width_ - kGradientReach, products[0].data(), products[1].data(),
                    products[2].data());
  for (std::size_t i = 0; i < products.size(); ++i) {
    SumSevens(products[i].data(), 1, kBorderPx, width_ - kBorderPx, sums_[i].data() + y * width_);
  }
}

void Harris::RespondAlongRow(int y) {
  thread_local std::array<Plane, 3> windows;
  for (std::size_t i = 0; i < windows.size(); ++i) {
    windows[i].resize(static_cast<std::size_t>(width_));
    SumSevens(sums_[i].data() + y * width_, width_, kBorderPx, width_ - kBorderPx, windows[i].data());
  }
  ToResponse(windows[0].data(), windows[1].data(), windows[2].data(), kBorderPx, width_ - kBorderPx,
             response_.data() + y * width_);
}

}  // namespace evo::tracking
