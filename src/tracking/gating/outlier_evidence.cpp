#include "tracking/gating/outlier_evidence.hpp"

#include <cmath>

namespace evo::tracking {

void OutlierEvidence::Add(const Eigen::Vector2d& offset, const Eigen::Matrix2d& shape_rate, double outlier_ratio) {
  const double gain = 1.0 / ++frames_;
  offset_ += gain * (offset - offset_);
  shape_rate_ += gain * (shape_rate - shape_rate_);
  outlier_ratio_ += gain * (outlier_ratio - outlier_ratio_);
}

OutlierScore OutlierEvidence::Score(const Eigen::Vector2d& epipolar_direction) const {
  const Eigen::Vector2d along = epipolar_direction.normalized();
  const double across = std::abs(along.x() * offset_.y() - along.y() * offset_.x());
  return {{across, shape_rate_.norm(), outlier_ratio_}};
}

}  // namespace evo::tracking
