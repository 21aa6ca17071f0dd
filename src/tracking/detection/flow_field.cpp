#include "tracking/detection/flow_field.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "evo/core/bilinear.hpp"
#include "tracking/detection/flow_estimation.hpp"

namespace evo::tracking {

namespace {

constexpr int kCellPx = 24;                // a patch of 31 px, of which each flow is estimated, overlaps the next one
constexpr double kNeighbourhoodPx = 40.0;  // a feature within this distance gives a cell its flow
constexpr double kDistanceFloorPx = 4.0;   // limits the weight of the nearest feature
constexpr double kInsideGrid = 1.001;      // cells: keeps the right and lower neighbours inside the grid

}  // namespace

FlowField::FlowField(int width, int height, const TrackerOptions& options)
    : options_(options),
      columns_(std::max(2, (width + kCellPx - 1) / kCellPx)),
      rows_(std::max(2, (height + kCellPx - 1) / kCellPx)),
      cells_(static_cast<std::size_t>(columns_ * rows_)) {}

Eigen::Vector2d FlowField::Centre(std::size_t index) const {
  const int column = static_cast<int>(index) % columns_;
  const int row = static_cast<int>(index) / columns_;
  return {(column + 0.5) * kCellPx, (row + 0.5) * kCellPx};
}

FlowField::Cell FlowField::AverageFeatures(const Eigen::Vector2d& centre,
                                           const std::vector<FlowSample>& features) const {
  Cell cell;
  double total = 0.0;
  for (const FlowSample& feature : features) {
    const double distance = (feature.position - centre).norm();
    if (distance > kNeighbourhoodPx) continue;
    const double weight = 1.0 / (kDistanceFloorPx + distance);
    cell.flow += weight * feature.flow;
    total += weight;
  }
  cell.is_known = total > 0.0;
  if (cell.is_known) cell.flow /= total;
  return cell;
}

FlowField::Cell FlowField::Estimate(const events::EventHistory& history, TimeNs t, const Eigen::Vector2d& centre,
                                    const Cell& start) const {
  Cell cell = start;
  if (!start.is_known) cell.flow.setZero();
  cell.is_known = EstimateCoarseFlow(history, t, centre, options_, &cell.flow);
  if (!cell.is_known) cell.flow.setZero();
  return cell;
}

void FlowField::Update(const events::EventHistory& history, TimeNs t, const std::vector<FlowSample>& features,
                       const Prediction& predict, ThreadPool* pool) {
  std::vector<Cell> next(cells_.size());
  pool->ForEach(cells_.size(), [&](std::size_t i) {
    const Eigen::Vector2d centre = Centre(i);
    next[i] = AverageFeatures(centre, features);
    if (next[i].is_known) return;
    const auto predicted = predict(centre);
    next[i] = Estimate(history, t, centre, predicted ? Cell{*predicted, true} : cells_[i]);
  });
  cells_ = std::move(next);
  FillUnknown();
}

void FlowField::FillUnknown() {
  const std::vector<Cell> before = cells_;
  for (int r = 0; r < rows_; ++r) {
    for (int c = 0; c < columns_; ++c) {
      Cell& cell = cells_[static_cast<std::size_t>(r * columns_ + c)];
      if (cell.is_known) continue;
      Eigen::Vector2d sum = Eigen::Vector2d::Zero();
      int count = 0;
      for (int dr = -1; dr <= 1; ++dr) {
        for (int dc = -1; dc <= 1; ++dc) {
          if (r + dr < 0 || r + dr >= rows_ || c + dc < 0 || c + dc >= columns_) continue;
          const Cell& neighbour = before[static_cast<std::size_t>((r + dr) * columns_ + c + dc)];
          if (!neighbour.is_known) continue;
          sum += neighbour.flow;
          ++count;
        }
      }
      if (count) cell.flow = sum / count;
    }
  }
}

Eigen::Vector2d FlowField::Interpolate(const Eigen::Vector2d& position) const {
  const BilinearCell<double> at(std::clamp(position.x() / kCellPx - 0.5, 0.0, columns_ - kInsideGrid),
                                std::clamp(position.y() / kCellPx - 0.5, 0.0, rows_ - kInsideGrid));
  const auto flow = [&](int dr, int dc) -> const Eigen::Vector2d& {
    return cells_[static_cast<std::size_t>((at.row + dr) * columns_ + at.column + dc)].flow;
  };
  // Not InterpolateBilinear, whose rounding differs.
  return (1 - at.fy) * ((1 - at.fx) * flow(0, 0) + at.fx * flow(0, 1)) +
         at.fy * ((1 - at.fx) * flow(1, 0) + at.fx * flow(1, 1));
}

}  // namespace evo::tracking
