#pragma once

#include <cstddef>
#include <vector>

namespace evo::tracking {

/// Smooths planes of histograms with a Gaussian; keeps its kernel and its memory. Cells outside a plane count as 0.
class HistogramSmoother {
 public:
  /// `sigma` is in cells.
  HistogramSmoother(int side, double sigma);

  /// Smooths `side` rows of `side` cells.
  void Smooth(const float* plane);
  /// The smooth plane: `side` rows of width() cells.
  const float* smooth() const { return smooth_.data() + margin_ * width_; }
  int width() const { return width_; }

 private:
  int side_;
  std::vector<float> kernel_;
  int margin_;  // empty rows above and below the plane, and the least number of empty cells between two rows
  int width_;   // cells in a row of the members that follow
  std::vector<float> plane_, rows_, smooth_;
};

}  // namespace evo::tracking
