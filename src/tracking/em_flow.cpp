#include "evo/tracking/em_flow.hpp"

#include <algorithm>
#include <cmath>

namespace evo {

namespace {

// Events also move the density that pulls them, so a plain M step closes only part of the gap.
constexpr double kOverRelaxation = 1.6;
constexpr double kSmallestVariance = 0.25;  // px^2, of the association

}  // namespace

FlowEstimator::FlowEstimator(int radius_px, int planes, const FlowOptions& options)
    : options_(options), map_(static_cast<int>(std::ceil(radius_px / options.cell_px)), planes) {}

double FlowEstimator::Refine(const LocalEvents& events, double half_window_s, Eigen::Vector2d* flow) {
  const auto per_cell = static_cast<float>(1.0 / options_.cell_px);
  // Bilinear votes blur by a variance of cell^2 / 6: what larger cells add is taken from the association's own.
  const double added = (options_.cell_px * options_.cell_px - 1.0) / 6.0;
  const double variance = std::max(options_.sigma_px * options_.sigma_px - added, kSmallestVariance);
  const double sigma = std::sqrt(variance) / options_.cell_px;
  double share = 0.0;
  for (int iteration = 0; iteration < options_.iterations; ++iteration) {
    const Eigen::Array2f v = flow->cast<float>();
    map_.Clear();
    for (std::size_t i = 0; i < events.size(); ++i) {
      const float t = events.dt[i];
      map_.Vote(per_cell * (events.x[i] - v.x() * t), per_cell * (events.y[i] - v.y() * t),
                map_.PlaneOf(events.polarity[i]), 1.0f);
    }
    field_.Build(map_, sigma, options_.outlier_share);

    // Regression of the pull on time with an offset: the events of a window need not be centred in time.
    Eigen::Array4f sums = Eigen::Array4f::Zero();    // of (weight, pull)
    Eigen::Array4f sums_t = Eigen::Array4f::Zero();  // the same times dt
    float sum_tt = 0.0f;
    for (std::size_t i = 0; i < events.size(); ++i) {
      const float t = events.dt[i];
      const auto pull = field_.At(per_cell * (events.x[i] - v.x() * t), per_cell * (events.y[i] - v.y() * t),
                                  map_.PlaneOf(events.polarity[i]));
      sums += pull;
      sums_t += t * pull;
      sum_tt += t * t * pull[0];
    }
    if (!(sums[0] > 0.0f)) return 0.0;
    const float mean_t = sums_t[0] / sums[0];
    const float spread = sum_tt - mean_t * sums_t[0];
    if (!(spread > 0.0f)) return 0.0;
    share = static_cast<double>(sums[0]) / static_cast<double>(events.size());
    // An event late by dt sits at u = x - v dt; pulling it by d means v should fall by d / dt.
    const Eigen::Array4f slope = (sums_t - mean_t * sums) / spread;
    const Eigen::Vector2d step = -options_.cell_px * Eigen::Vector2d(slope[1], slope[2]);
    *flow += kOverRelaxation * step;
    if (step.norm() * half_window_s < options_.settled_px) break;
  }
  return share;
}

}  // namespace evo
