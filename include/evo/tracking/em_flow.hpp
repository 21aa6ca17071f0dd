#pragma once

#include <Eigen/Core>

#include "evo/events/event_history.hpp"
#include "evo/tracking/density_map.hpp"

namespace evo {

struct FlowOptions {
  double sigma_px = 1.5;
  double outlier_share = 0.5;
  int iterations = 20;
  double half_window_s = 0.01;
};

/// Expectation maximisation of the optical flow of a patch (Zhu et al., EM 1): events propagated by the right flow to
/// the reference instant pile up on the edges that made them. E step: the mean shift in the density of the propagated
/// events; M step: flow += sum w dx dt / sum w dt^2, in closed form.
class FlowEstimator {
 public:
  /// Of patches up to `radius_px`; cells larger than 1 px make it cheaper and coarser.
  FlowEstimator(int radius_px, int planes, double cell_px);

  /// Refines `flow` (px/s); returns the share of events that belong to an edge under the final flow.
  double Refine(const LocalEvents& events, const FlowOptions& options, Eigen::Vector2d* flow);

 private:
  double cell_px_;
  DensityMap map_;
  AssociationField field_;
};

}  // namespace evo
