#include "tracking/patch/em_flow.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "tracking/patch/density_map.hpp"
#include "tracking/patch/event_lanes.hpp"

namespace evo::tracking {

namespace {

// Events also move the density that pulls them, so a plain M step closes only part of the gap.
constexpr double kOverRelaxation = 1.6;
constexpr double kSmallestVariance = 0.25;  // px^2, of the association

// Bilinear votes blur by a variance of cell^2 / 6: what larger cells add is taken from the association's own.
double SigmaInCells(const FlowOptions& options) {
  const double added = (options.cell_px * options.cell_px - 1.0) / 6.0;
  return std::sqrt(std::max(options.sigma_px * options.sigma_px - added, kSmallestVariance)) / options.cell_px;
}

/// Kept by each thread for each size of patch.
struct Workspace {
  Workspace(int radius, int planes) : map(radius, planes) {}

  DensityMap map;
  AssociationField field;
  std::vector<float> u, v;  // cells
};

Workspace& WorkspaceOf(int radius, int planes) {
  thread_local std::map<std::pair<int, int>, Workspace> workspaces;
  return workspaces.try_emplace({radius, planes}, radius, planes).first->second;
}

/// Along `flow` to the reference instant.
void Propagate(const events::LocalEvents& events, const Eigen::Vector2f& flow, float per_cell, std::vector<float>* u,
               std::vector<float>* v) {
  u->resize(events.size());
  v->resize(events.size());
  for (std::size_t i = 0; i < events.size(); ++i) {
    (*u)[i] = per_cell * (events.x[i] - flow.x() * events.dt[i]);
    (*v)[i] = per_cell * (events.y[i] - flow.y() * events.dt[i]);
  }
}

/// Sums over the events, of weights and pulls (cells) and of their products with dt.
struct PullSums {
  float w, wt, wtt, x, xt, y, yt;
};

/// Of the events, which lie at (u, v).
EVO_HOT void SumPulls(const events::LocalEvents& events, std::span<const float> us, std::span<const float> vs,
                      const AssociationField& field, int planes, PullSums* sums) {
  Lanes w{}, wt{}, wtt{}, sum_x{}, xt{}, sum_y{}, yt{};
  const std::int32_t second = planes == 2 ? field.side() * field.side() : 0;
  for (std::size_t begin = 0; begin < events.size(); begin += kLanes) {
    Lanes u, v, dt;
    Load(us, begin, kOutside, &u);
    Load(vs, begin, kOutside, &v);
    Load(events.dt, begin, 0.0f, &dt);
    std::int32_t planes_of[kLanes];
    FindPlanes(events.polarity, begin, second, planes_of);
    LaneColumns pull;
    PullsAt(field, u, v, planes_of, &pull);
    const auto& [inlier, pull_x, pull_y, weight] = pull;
    const Lanes pt = inlier * dt;
    w += inlier;
    wt += pt;
    wtt += pt * dt;
    sum_x += pull_x;
    xt += pull_x * dt;
    sum_y += pull_y;
    yt += pull_y * dt;
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
  Workspace& w = WorkspaceOf(radius_, planes_);
  const auto per_cell = static_cast<float>(1.0 / options_.cell_px);
  double share = 0.0;
  for (int iteration = 0; iteration < options_.iterations; ++iteration) {
    Propagate(events, flow->cast<float>(), per_cell, &w.u, &w.v);
    w.map.Clear();
    w.map.Vote(w.u, w.v, events.polarity);
    w.field.Build(w.map, sigma_, options_.outlier_share, AssociationField::Weight::kEven);

    // Regression of the pull on time with an offset: the events of a window need not be centred in time.
    PullSums s;
    SumPulls(events, w.u, w.v, w.field, planes_, &s);
    if (!(s.w > 0.0f)) return 0.0;
    const float mean_t = s.wt / s.w;
    const float spread = s.wtt - mean_t * s.wt;
    if (!(spread > 0.0f)) return 0.0;
    share = static_cast<double>(s.w) / static_cast<double>(events.size());
    // An event late by dt sits at u = x - v dt; pulling it by d means v should fall by d / dt.
    const Eigen::Vector2d slope((s.xt - mean_t * s.x) / spread, (s.yt - mean_t * s.y) / spread);
    const Eigen::Vector2d step = -options_.cell_px * slope;
    *flow += kOverRelaxation * step;
    if (step.norm() * half_window_s < options_.settled_px) break;
  }
  return share;
}

}  // namespace evo::tracking
