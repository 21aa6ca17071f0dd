#include "tracking/detection/flow_field.hpp"

#include <algorithm>
#include <cmath>

#include "tracking/patch/em_flow.hpp"

namespace evo::tracking {

namespace {

constexpr int kCellPx = 24;
constexpr double kNeighbourhoodPx = 40.0;  // features this near tell a cell its flow
// Of the windows that only have to lead near the flow: a quarter of the cost, and near enough for an image of events.
constexpr double kCoarseCellPx = 2.0;
constexpr double kCoarselySettledPx = 0.1;
constexpr double kSettledPx = 0.02;
constexpr double kCautiousShare = 1.0;  // of a window's motion, while the flow comes from elsewhere

FlowEstimator MakeEstimator(int radius_px, double cell_px, double sigma_px, double settled_px,
                            const TrackerOptions& options) {
  return {radius_px + 2,
          options.use_polarity ? 2 : 1,
          {cell_px, sigma_px, options.outlier_density_ratio, options.iterations, settled_px}};
}

bool GatherForFlow(const events::EventHistory& history, TimeNs t, double x, double y, const Eigen::Vector2d& flow,
                   int radius_px, TimeNs half_window, const TrackerOptions& options, events::LocalEvents* events) {
  history.Gather({t, x, y, flow.x(), flow.y(), static_cast<double>(radius_px), half_window}, events);
  events->Thin(static_cast<std::size_t>(options.max_events));
  return events->size() >= static_cast<std::size_t>(options.min_events);
}

/// Comes near the flow, from `flow` or from nothing; false where there are too few events.
bool EstimateCoarseFlow(const events::EventHistory& history, TimeNs t, double x, double y,
                        const TrackerOptions& options, Eigen::Vector2d* flow) {
  thread_local events::LocalEvents events;
  // A short window hardly moves the events even if the flow is unknown, but tells little of a slow flow; each window
  // twice as long starts from a flow known twice as well, until the events have moved far enough.
  const int radius_px = options.flow_patch_radius_px;
  const FlowEstimator coarse =
      MakeEstimator(radius_px, kCoarseCellPx, options.flow_sigma_px, kCoarselySettledPx, options);
  const TimeNs longest = FromSeconds(0.5 * options.max_window_s);
  TimeNs half_window = flow->isZero() ? FromSeconds(0.5 * options.min_window_s)
                                      : HalfWindow(*flow, kCautiousShare * options.window_motion_px, options);
  bool found = false;
  for (bool settled = false; !settled; half_window *= 2) {
    half_window = std::min(half_window, longest);
    settled = half_window == longest;
    if (!GatherForFlow(history, t, x, y, *flow, radius_px, half_window, options, &events)) continue;
    if (!(coarse.Refine(events, ToSeconds(half_window), flow) > 0.0)) return false;
    found = true;
    settled = settled || flow->norm() * 2.0 * ToSeconds(half_window) >= options.window_motion_px;
  }
  return found;
}

}  // namespace

TimeNs HalfWindow(const Eigen::Vector2d& flow, double motion_px, const TrackerOptions& options) {
  const double window = motion_px / std::max(flow.norm(), 1e-3);
  return FromSeconds(0.5 * std::min(std::max(window, options.min_window_s), options.max_window_s));
}

bool EstimateFlow(const events::EventHistory& history, TimeNs t, double x, double y, const TrackerOptions& options,
                  Eigen::Vector2d* flow) {
  if (!EstimateCoarseFlow(history, t, x, y, options, flow)) return false;
  // A feature's own patch, as what is around it may be of another depth.
  thread_local events::LocalEvents events;
  const FlowEstimator fine = MakeEstimator(options.patch_radius_px, 1.0, options.fine_sigma_px, kSettledPx, options);
  const TimeNs half_window = HalfWindow(*flow, options.window_motion_px, options);
  return GatherForFlow(history, t, x, y, *flow, options.patch_radius_px, half_window, options, &events) &&
         fine.Refine(events, ToSeconds(half_window), flow) > 0.0;
}

FlowField::FlowField(int width, int height, const TrackerOptions& options)
    : options_(options),
      columns_(std::max(2, (width + kCellPx - 1) / kCellPx)),
      rows_(std::max(2, (height + kCellPx - 1) / kCellPx)),
      cells_(static_cast<std::size_t>(columns_ * rows_)) {}

Eigen::Vector2d FlowField::CentreOf(std::size_t index) const {
  const auto i = static_cast<int>(index);
  return {(i % columns_ + 0.5) * kCellPx, (static_cast<double>(i / columns_) + 0.5) * kCellPx};
}

FlowField::Cell FlowField::FromFeatures(std::size_t index, const std::vector<FlowSample>& features) const {
  const Eigen::Vector2d centre = CentreOf(index);
  Cell cell;
  double total = 0.0;
  for (const FlowSample& feature : features) {
    const double distance = (feature.position - centre).norm();
    if (distance > kNeighbourhoodPx) continue;
    const double weight = 1.0 / (4.0 + distance);
    cell.flow += weight * feature.flow;
    total += weight;
  }
  cell.known = total > 0.0;
  if (cell.known) cell.flow /= total;
  return cell;
}

FlowField::Cell FlowField::Estimate(const events::EventHistory& history, TimeNs t, const Eigen::Vector2d& centre,
                                    const Cell& start) const {
  Cell cell = start;
  if (!start.known) cell.flow.setZero();
  cell.known = EstimateCoarseFlow(history, t, centre.x(), centre.y(), options_, &cell.flow);
  if (!cell.known) cell.flow.setZero();
  return cell;
}

FlowField::Cell FlowField::Start(std::size_t index, const Guess& guess) const {
  const auto guessed = guess(CentreOf(index));
  return guessed ? Cell{*guessed, true} : cells_[index];
}

void FlowField::Update(const events::EventHistory& history, TimeNs t, const std::vector<FlowSample>& features,
                       const Guess& guess, ThreadPool* pool) {
  std::vector<Cell> next(cells_.size());
  pool->ForEach(cells_.size(), [&](std::size_t i) {
    const Cell known = FromFeatures(i, features);
    next[i] = known.known ? known : Estimate(history, t, CentreOf(i), Start(i, guess));
  });
  cells_ = std::move(next);
  FillUnknown();
}

void FlowField::FillUnknown() {
  const std::vector<Cell> before = cells_;
  for (int r = 0; r < rows_; ++r) {
    for (int c = 0; c < columns_; ++c) {
      Cell& cell = cells_[static_cast<std::size_t>(r * columns_ + c)];
      if (cell.known) continue;
      Eigen::Vector2d sum = Eigen::Vector2d::Zero();
      int count = 0;
      for (int dr = -1; dr <= 1; ++dr) {
        for (int dc = -1; dc <= 1; ++dc) {
          if (r + dr < 0 || r + dr >= rows_ || c + dc < 0 || c + dc >= columns_) continue;
          const Cell& neighbour = before[static_cast<std::size_t>((r + dr) * columns_ + c + dc)];
          if (!neighbour.known) continue;
          sum += neighbour.flow;
          ++count;
        }
      }
      if (count) cell.flow = sum / count;
    }
  }
}

Eigen::Vector2d FlowField::At(double x, double y) const {
  const double column = std::clamp(x / kCellPx - 0.5, 0.0, columns_ - 1.001);
  const double row = std::clamp(y / kCellPx - 0.5, 0.0, rows_ - 1.001);
  const int c = static_cast<int>(column);
  const int r = static_cast<int>(row);
  const double fx = column - c;
  const double fy = row - r;
  const auto flow = [&](int dr, int dc) -> const Eigen::Vector2d& {
    return cells_[static_cast<std::size_t>((r + dr) * columns_ + c + dc)].flow;
  };
  return (1 - fy) * ((1 - fx) * flow(0, 0) + fx * flow(0, 1)) + fy * ((1 - fx) * flow(1, 0) + fx * flow(1, 1));
}

}  // namespace evo::tracking
