#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "evo/core/parallel.hpp"
#include "evo/events/event_history.hpp"
#include "evo/tracking/tracker_options.hpp"
#include "tracking/motion/flow_sample.hpp"

namespace evo::tracking {

/// Optical flow of the whole sensor on a coarse grid. It compensates the motion in the image on which corners are
/// detected, and gives new features their first flow.
class FlowField {
 public:
  FlowField(int width, int height, const TrackerOptions& options);

  /// Predicts the flow at a position without features around it, px/s. Empty if unknown.
  using Prediction = std::function<std::optional<Eigen::Vector2d>(const Eigen::Vector2d& position)>;

  /// Averages the flow of the features around each cell. A cell without features is estimated from its events, started
  /// from the prediction or, without one, from its last flow.
  void Update(const events::EventHistory& history, TimeNs t, const std::vector<FlowSample>& features,
              const Prediction& predict, ThreadPool* pool);

  /// Bilinear interpolation, px/s; zero where nothing moves.
  Eigen::Vector2d Interpolate(const Eigen::Vector2d& position) const;

 private:
  struct Cell {
    Eigen::Vector2d flow = Eigen::Vector2d::Zero();  // px/s
    bool is_known = false;
  };

  Cell AverageFeatures(const Eigen::Vector2d& centre, const std::vector<FlowSample>& features) const;
  Cell Estimate(const events::EventHistory& history, TimeNs t, const Eigen::Vector2d& centre, const Cell& start) const;
  /// The centre of a cell, px.
  Eigen::Vector2d Centre(std::size_t index) const;
  /// Gives unknown cells the mean of their known neighbours.
  void FillUnknown();

  TrackerOptions options_;
  int columns_;
  int rows_;
  std::vector<Cell> cells_;
};

}  // namespace evo::tracking
