#include "odometry/frontend/frame.hpp"

#include <algorithm>
#include <utility>

#include "evo/core/median.hpp"

namespace evo::odometry {

const Feature* Frame::Find(std::int64_t track) const {
  const auto found = std::ranges::lower_bound(features, track, {}, &Feature::track);
  return found == features.end() || found->track != track ? nullptr : &*found;
}

std::vector<FeaturePair> Match(const Frame& first, const Frame& second) {
  std::vector<FeaturePair> pairs;
  auto a = first.features.begin();
  auto b = second.features.begin();
  while (a != first.features.end() && b != second.features.end()) {
    if (a->track == b->track) {
      pairs.push_back({&*a++, &*b++});
    } else if (a->track < b->track) {
      ++a;
    } else {
      ++b;
    }
  }
  return pairs;
}

double MedianDisparity(const std::vector<FeaturePair>& pairs) {
  std::vector<double> disparities;
  disparities.reserve(pairs.size());
  for (const auto& [first, second] : pairs) {
    const Eigen::Matrix2d J_pixel_normalized = 0.5 * (first->J_pixel_normalized + second->J_pixel_normalized);
    disparities.push_back((J_pixel_normalized * (second->x - first->x)).norm());
  }
  return Median(std::move(disparities));
}

}  // namespace evo::odometry
