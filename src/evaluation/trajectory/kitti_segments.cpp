#include "evaluation/trajectory/kitti_segments.hpp"

#include <cstddef>
#include <numbers>

namespace evo::evaluation {

namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

}  // namespace

KittiSegments ComputeKittiSegments(const MatchedTrajectory& trajectory, std::span<const double> lengths_m, int step) {
  KittiSegments segments;
  segments.step = step;
  std::vector<double> all_translations;
  std::vector<double> all_rotations;
  for (const double length : lengths_m) {
    std::vector<double> translations;
    std::vector<double> rotations;
    std::size_t last = 0;  // distances never decrease, so ends only move forward
    for (std::size_t first = 0; first < trajectory.size(); first += static_cast<std::size_t>(step)) {
      while (last < trajectory.size() && trajectory.distance[last] <= trajectory.distance[first] + length) ++last;
      if (last == trajectory.size()) break;
      translations.push_back(100.0 * trajectory.TranslationError(first, last) / length);
      rotations.push_back(kDegrees * RotationAngle(trajectory.RotationError(first, last)) / length);
    }
    if (translations.empty()) continue;
    segments.lengths.push_back({length, ComputeStatistics(translations), ComputeStatistics(rotations)});
    all_translations.insert(all_translations.end(), translations.begin(), translations.end());
    all_rotations.insert(all_rotations.end(), rotations.begin(), rotations.end());
  }
  segments.translation_percent = ComputeStatistics(all_translations);
  segments.rotation_deg_per_m = ComputeStatistics(all_rotations);
  return segments;
}

}  // namespace evo::evaluation
