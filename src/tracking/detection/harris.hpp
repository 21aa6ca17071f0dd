#pragma once

#include <array>
#include <cstddef>
#include <opencv2/core.hpp>
#include <vector>

#include "evo/core/parallel.hpp"

namespace evo::tracking {

/// Corner response of C. Harris and M. Stephens (A Combined Corner and Edge Detector, 1988) on windows of 7 x 7 px.
/// OpenCV's would allocate several images in each call and use one thread.
class Harris {
 public:
  /// The response is zero closer to the image's edge than this.
  static constexpr int kBorderPx = 7;

  /// Computes the response to the square root of `image` (CV_32F, not negative), smoothed by 1 px. The root balances
  /// pixels with many events and pixels with one.
  void Respond(const cv::Mat& image, ThreadPool* pool);

  /// A row of the response, without a unit: positive at corners, negative at edges.
  const float* row(int y) const { return response_.data() + y * width_; }

 private:
  using Plane = std::vector<float>;

  void SmoothAlongRow(const float* image, int y);
  void SmoothAlongColumn(int y);
  void SumGradientsAlongRow(int y);
  void RespondAlongRow(int y);

  std::ptrdiff_t width_ = 0;
  Plane rows_, smooth_;
  std::array<Plane, 3> sums_;  // of the products xx, xy and yy of the gradients, over 7 px of a row
  Plane response_;
};

}  // namespace evo::tracking
