#pragma once

#include <Eigen/Core>

#include "evo/events/event_history.hpp"

namespace evo::tracking {

struct FlowOptions {
  double cell_px = 1.0;  ///< of the density: larger cells are cheaper and coarser
  double sigma_px = 1.5;
  double outlier_share = 0.5;
  int iterations = 20;
  double settled_px = 0.02;  ///< a step that moves the events at the window's ends by less than this is the last
};

/// Expectation maximisation of the optical flow of a patch (Zhu et al., EM 1): events propagated by the right flow to
/// the reference instant pile up on the edges that made them. E step: the mean shift in the density of the propagated
/// events; M step: flow += sum w dx dt / sum w dt^2, in closed form.
class FlowEstimator {
 public:
  FlowEstimator(int radius_px, int planes, const FlowOptions& options);

  /// Refines `flow` (px/s) on the events of a window; returns the share of them that belong to an edge under it.
  double Refine(const events::LocalEvents& events, double half_window_s, Eigen::Vector2d* flow) const;

 private:
  FlowOptions options_;
  double sigma_;  // cells
  int radius_;    // cells
  int planes_;
};

}  // namespace evo::tracking
