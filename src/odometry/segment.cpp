#include "odometry/segment.hpp"

namespace evo::odometry {

std::vector<geometry::Matrix6d> Segment::Covariances(bool scale_is_free) const {
  std::vector<geometry::Matrix6d> covariances;
  if (adjusted.empty() || !uncertainty.known()) return covariances;
  const auto of_adjusted = uncertainty.Covariances(0, scale_is_free);
  std::size_t k = 0;
  for (std::size_t i = 0; i < besides.size(); ++i) {
    while (k + 1 < adjusted.size() && adjusted[k + 1] <= i) ++k;
    covariances.push_back(of_adjusted[k] + besides[i]);
  }
  return covariances;
}

}  // namespace evo::odometry
