#include "tracking/patch/em_flow.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "tracking/patch/association_table.hpp"
#include "tracking/patch/event_histogram.hpp"
#include "tracking/patch/event_simd8.hpp"

namespace evo::tracking {

namespace {

// Moving the events also moves the density that attracts them, so a plain M step closes only part of the gap.
constexpr double kOverRelaxation = 1.6;
constexpr double kMinVariance = 0.25;  // of the association, px^2: half a pixel

// Bilinear votes add a variance of cell^2 / 6; what cells larger than 1 px add is subtracted from the association's.
double SigmaInCells(const FlowOptions& options) {
  const double added = (options.cell_px * options.cell_px - 1.0) / 6.0;
  return std::sqrt(std::max(options.sigma_px * options.sigma_px - added, kMinVariance)) / options.cell_px;
}

/// Memory that each thread keeps for each size of patch.
struct Workspace {
  Workspace(int radius, int planes) : histogram(radius, planes) {}

  static Workspace& ForThread(int radius, int planes) {
    thread_local std::map<std::pair<int, int>, Workspace> workspaces;
    return workspaces.try_emplace({radius, planes}, radius, planes).first->second;
  }

  EventHistogram histogram;
  AssociationTable associations;
  std::vector<float> u, v;  // cells
};

/// Moves the events along `flow` to the reference instant.
void Propagate(const events::LocalEvents& events, const Eigen::Vector2f& flow, float cells_per_px,
               std::vector<float>* u, std::vector<float>* v) {
  u->resize(events.size());
  v->resize(events.size());
  for (std::size_t i = 0; i < events.size(); ++i) {
    (*u)[i] = cells_per_px * (events.x[i] - flow.x() * events.dt[i]);
    (*v)[i] = cells_per_px * (events.y[i] - flow.y() * events.dt[i]);
  }
}

/// Sums over the events of inlier probabilities w, of weighted shifts (x, y) in cells, and of their products with dt.
struct ShiftSums {
  float w, wt, wtt, x, xt, y, yt;
};

/// Sums over the events, which lie at (u, v) in cells.
EVO_HOT void SumShifts(const events::LocalEvents& events, std::span<const float> us, std::span<const float> vs,
                       const AssociationTable& table, int planes, ShiftSums* sums) {
  F32x8 w{}, wt{}, wtt{}, sum_x{}, xt{}, sum_y{}, yt{};
  const std::int32_t negative_offset = planes == 2 ? table.side() * table.side() : 0;
  for (std::size_t begin = 0; begin < events.size(); begin += kLanes) {
    F32x8 u, v, dt;
    Load(us, begin, kOutsidePx, &u);
    Load(vs, begin, kOutsidePx, &v);
    Load(events.dt, begin, 0.0f, &dt);
    std::int32_t plane_offsets[kLanes];
    FindPlaneOffsets(events.polarity, begin, negative_offset, plane_offsets);
    Columns8 associations;
    InterpolateAssociations(table, u, v, plane_offsets, &associations);
    const auto& [inlier, shift_x, shift_y, weight] = associations;
    const F32x8 pt = inlier * dt;
    w += inlier;
    wt += pt;
    wtt += pt * dt;
    sum_x += shift_x;
    xt += shift_x * dt;
    sum_y += shift_y;
    yt += shift_y * dt;
  }
  *sums = {Sum(w), Sum(wt), Sum(wtt), Sum(sum_x), Sum(xt), Sum(sum_y), Sum(yt)};
}

}  // namespace

FlowEstimator::FlowEstimator(int radius_px, int planes, const FlowOptions& options)
    : options_(options),
      sigma_(SigmaInCells(options)),
      radius_(static_cast<int>(std::ceil(radius_px / options.cell_px))),
      planes_(planes) {}

double FlowEstimator::Refine(const events::LocalEvents& events, double half_window_s, Eigen::Vector2d* flow) const {
  Workspace& w = Workspace::ForThread(radius_, planes_);
  const auto cells_per_px = static_cast<float>(1.0 / options_.cell_px);
  double inlier_ratio = 0.0;
  for (int iteration = 0; iteration < options_.iterations; ++iteration) {
    Propagate(events, flow->cast<float>(), cells_per_px, &w.u, &w.v);
    w.histogram.Clear();
    w.histogram.Vote(w.u, w.v, events.polarity);
    w.associations.Build(w.histogram, sigma_, options_.outlier_density_ratio, AssociationTable::Weighting::kUniform);

    // The regression of the shift on time has an offset, since the events of a window need not be centred in time.
    ShiftSums s;
    SumShifts(events, w.u, w.v, w.associations, planes_, &s);
    if (!(s.w > 0.0f)) return 0.0;
    const float mean_t = s.wt / s.w;
    const float spread = s.wtt - mean_t * s.wt;
    if (!(spread > 0.0f)) return 0.0;
    inlier_ratio = static_cast<double>(s.w) / static_cast<double>(events.size());
    // An event dt late lies at u = x - v dt, so a shift of d asks v to change by -d / dt.
    const Eigen::Vector2d slope((s.xt - mean_t * s.x) / spread, (s.yt - mean_t * s.y) / spread);
    const Eigen::Vector2d step = -options_.cell_px * slope;
    *flow += kOverRelaxation * step;
    if (step.norm() * half_window_s < options_.convergence_px) break;
  }
  return inlier_ratio;
}

}  // namespace evo::tracking
