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

/// Optical flow over the whole sensor on a coarse grid, by EM on the events of each cell. It corrects the events of the
/// image on which corners are detected and gives new features their first flow.
class FlowField {
 public:
  FlowField(int width, int height, const TrackerOptions& options);

  /// What may be known of the flow at a place that no feature is near to, px/s.
  using Guess = std::function<std::optional<Eigen::Vector2d>(const Eigen::Vector2d& position)>;

  /// Takes each cell's flow from the features around it, else estimates it, started from the guess or, without one,
  /// from its own last value.
  void Update(const events::EventHistory& history, TimeNs t, const std::vector<FlowSample>& features,
              const Guess& guess, ThreadPool* pool);

  /// Bilinear, px/s; zero where nothing moves.
  Eigen::Vector2d At(double x, double y) const;

 private:
  struct Cell {
    Eigen::Vector2d flow = Eigen::Vector2d::Zero();
    bool known = false;
  };

  Cell Start(std::size_t index, const Guess& guess) const;
  Cell Estimate(const events::EventHistory& history, TimeNs t, const Eigen::Vector2d& centre, const Cell& start) const;
  Cell FromFeatures(std::size_t index, const std::vector<FlowSample>& features) const;
  Eigen::Vector2d CentreOf(std::size_t index) const;
  void FillUnknown();

  TrackerOptions options_;
  int columns_;
  int rows_;
  std::vector<Cell> cells_;
};

/// Half the window in which `flow` moves a feature by `motion_px`, within the options' limits.
TimeNs HalfWindow(const Eigen::Vector2d& flow, double motion_px, const TrackerOptions& options);

/// Flow of the events around (x, y) at `t`, from `flow` or, if that is zero, from nothing: windows of growing length,
/// each started from the flow of the one before, the last over a feature's own patch. Returns false where there are too
/// few events for a flow.
bool EstimateFlow(const events::EventHistory& history, TimeNs t, double x, double y, const TrackerOptions& options,
                  Eigen::Vector2d* flow);

}  // namespace evo::tracking
