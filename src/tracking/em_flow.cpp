#include "evo/tracking/em_flow.hpp"

#include <algorithm>
#include <cmath>

namespace evo {

namespace {

// Events also move the density that pulls them, so a plain M step closes only part of the gap.
constexpr double kOverRelaxation = 1.6;
constexpr double kSmallestVariance = 0.25;  // px^2, of the association

// Bilinear votes blur by a variance of cell^2 / 6: what larger cells add is taken from the association's own.
double SigmaInCells(const FlowOptions& options) {
  const double added = (options.cell_px * options.cell_px - 1.0) / 6.0;
  return std::sqrt(std::max(options.sigma_px * options.sigma_px - added, kSmallestVariance)) / options.cell_px;
}

}  // namespace

FlowEstimator::FlowEstimator(int radius_px, int planes, const FlowOptions& options)
    : options_(options),
      by_polarity_(planes == 2),
      density_(static_cast<int>(std::ceil(radius_px / options.cell_px)), planes, SigmaInCells(options)) {}

void FlowEstimator::Propagate(const LocalEvents& events, const Eigen::Vector2d& flow) {
  const auto per_cell = static_cast<float>(1.0 / options_.cell_px);
  const Eigen::Array2f v = flow.cast<float>();
  u_.resize(events.size());
  v_.resize(events.size());
  for (std::size_t i = 0; i < events.size(); ++i) {
    u_[i] = per_cell * (events.x[i] - v.x() * events.dt[i]);
    v_[i] = per_cell * (events.y[i] - v.y() * events.dt[i]);
  }
}

double FlowEstimator::Refine(const LocalEvents& events, double half_window_s, Eigen::Vector2d* flow) {
  const auto plane = [&](std::size_t i) { return by_polarity_ && events.polarity[i] < 0 ? 1 : 0; };
  double share = 0.0;
  for (int iteration = 0; iteration < options_.iterations; ++iteration) {
    Propagate(events, *flow);
    density_.Clear();
    for (std::size_t i = 0; i < events.size(); ++i) density_.Vote(u_[i], v_[i], plane(i));
    density_.Smooth(options_.outlier_share);

    // Regression of the pull on time with an offset: the events of a window need not be centred in time.
    float sum = 0.0f, sum_x = 0.0f, sum_y = 0.0f, sum_t = 0.0f, sum_tt = 0.0f, sum_tx = 0.0f, sum_ty = 0.0f;
    for (std::size_t i = 0; i < events.size(); ++i) {
      const EventDensity::Pull pull = density_.At(u_[i], v_[i], plane(i));
      const float t = events.dt[i];
      sum += pull.weight;
      sum_x += pull.x;
      sum_y += pull.y;
      sum_t += t * pull.weight;
      sum_tt += t * t * pull.weight;
      sum_tx += t * pull.x;
      sum_ty += t * pull.y;
    }
    if (!(sum > 0.0f)) return 0.0;
    const float mean_t = sum_t / sum;
    const float spread = sum_tt - mean_t * sum_t;
    if (!(spread > 0.0f)) return 0.0;
    share = static_cast<double>(sum) / static_cast<double>(events.size());
    // An event late by dt sits at u = x - v dt; pulling it by d means v should fall by d / dt.
    const Eigen::Vector2d slope((sum_tx - mean_t * sum_x) / spread, (sum_ty - mean_t * sum_y) / spread);
    const Eigen::Vector2d step = -options_.cell_px * slope;
    *flow += kOverRelaxation * step;
    if (step.norm() * half_window_s < options_.settled_px) break;
  }
  return share;
}

}  // namespace evo
