#pragma once

#include <Eigen/Core>

namespace evo::tracking {

/// The pixels of a sensor that are at least `border_px` away from its edge.
class SensorArea {
 public:
  SensorArea(int width, int height, double border_px)
      : border_(border_px), right_(width - 1 - border_px), bottom_(height - 1 - border_px) {}

  bool Contains(const Eigen::Vector2d& position) const {
    return position.x() >= border_ && position.y() >= border_ && position.x() <= right_ && position.y() <= bottom_;
  }

 private:
  double border_;  // px
  double right_;   // px
  double bottom_;  // px
};

}  // namespace evo::tracking
