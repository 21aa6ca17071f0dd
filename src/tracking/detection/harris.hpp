#pragma once

#include <array>
#include <cstddef>
#include <opencv2/core.hpp>
#include <vector>

#include "evo/core/parallel.hpp"

namespace evo::tracking {

/// The Harris response of images of one size, on windows of 7 x 7 px. Its own loops and not OpenCV's, which would
/// allocate several images each time and use one thread.
class Harris {
 public:
  /// No response is computed nearer to the edge of the image.
  static constexpr int kBorderPx = 7;

  /// Responds to the square root of `image` (CV_32F, not negative), smoothed by 1 px: the root evens out pixels that
  /// fire often and pixels that fire once. The same for any number of threads.
  void Respond(const cv::Mat& image, ThreadPool* pool);

  /// In no particular unit; positive at corners, zero at the border.
  const float* row(int y) const { return response_.data() + y * width_; }

 private:
  using Plane = std::vector<float>;

  void SmoothAlongRow(const float* image, int y);
  void SmoothAlongColumn(int y);
  void SumGradientsAlongRow(int y);
  void RespondAlongRow(int y);

  std::ptrdiff_t width_ = 0;
  Plane rows_, smooth_;
  std::array<Plane, 3> sums_;  // of the gradients' products xx, xy and yy over 7 px of a row
  Plane response_;
};

}  // namespace evo::tracking
