#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "evo/core/bilinear.hpp"

namespace evo::tracking {

/// A coordinate outside every histogram, px: padding events lie there.
inline constexpr float kOutsidePx = 1e6f;

/// Histogram of the events around a feature: square, of 1 px cells, centred on (0, 0), with one plane per polarity (or
/// one plane for both).
class EventHistogram {
 public:
  EventHistogram(int radius_px, int planes);

  int radius() const { return radius_; }
  int side() const { return 2 * radius_ + 1; }
  int planes() const { return planes_; }
  int PlaneOf(std::int8_t polarity) const { return planes_ == 2 && polarity < 0 ? 1 : 0; }
  const float* plane(int p) const { return cells_.data() + p * side() * side(); }
  /// Sum of all cells.
  double Total() const { return total_; }
  /// Number of cells that the events would fill if they were spread evenly: (sum n)^2 / sum n^2.
  double EffectiveCells() const;

  void Clear();
  void Scale(float factor);
  /// Becomes `keep` times itself plus `factor` times another histogram of the same size.
  void Blend(float keep, const EventHistogram& other, float factor);
  /// Adds an event bilinearly to the four cells around it; an event outside is ignored.
  void Vote(float x, float y, int plane, float weight) {
    const float column = x + static_cast<float>(radius_);
    const float row = y + static_cast<float>(radius_);
    const auto last = static_cast<float>(side() - 1);
    if (!(column >= 0.0f && row >= 0.0f && column < last && row < last)) return;
    const BilinearCell<float> at(column, row);
    total_ += weight;
    float* cell = cells_.data() + (plane * side() + at.row) * side() + at.column;
    cell[0] += weight * (1.0f - at.fx) * (1.0f - at.fy);
    cell[1] += weight * at.fx * (1.0f - at.fy);
    cell[side()] += weight * (1.0f - at.fx) * at.fy;
    cell[side() + 1] += weight * at.fx * at.fy;
  }
  /// Adds many events, each of weight 1.
  void Vote(std::span<const float> x, std::span<const float> y, std::span<const std::int8_t> polarity);
  /// Exchanges the given ratio of each cell between the two planes.
  void ExchangePlanes(std::span<const float> ratios);
  /// The histogram in other coordinates: a cell at u moves to `linear` * u / (1 + `perspective` . u).
  EventHistogram Warped(const Eigen::Matrix2d& linear,
                        const Eigen::Vector2d& perspective = Eigen::Vector2d::Zero()) const;

 private:
  int radius_;
  int planes_;
  std::vector<float> cells_;
  double total_ = 0.0;
};

}  // namespace evo::tracking
