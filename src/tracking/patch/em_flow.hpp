#pragma once

#include <Eigen/Core>

#include "evo/events/event_history.hpp"

namespace evo::tracking {

struct FlowOptions {
  double cell_px = 1.0;   ///< of the histogram; larger cells are cheaper and coarser
  double sigma_px = 1.5;  ///< of the soft association
  double outlier_density_ratio = 0.5;
  int iterations = 20;           ///< maximum
  double convergence_px = 0.02;  ///< a step that moves the events at the window's ends by less is the last
};

/// Expectation maximisation of the optical flow of a patch (EM 1 of A. Z. Zhu et al., ICRA 2017).
/// Events that are propagated along the true flow to the reference instant pile up on the edges that caused them. E
/// step: the mean shift dx of every event in the density of all propagated events, and its inlier probability w. M
/// step: the flow changes by the slope of -dx over dt, by least squares weighted with w, in closed form.
class FlowEstimator {
 public:
  FlowEstimator(int radius_px, int planes, const FlowOptions& options);

  /// Refines `flow` (px/s) on the events of a window. Returns the ratio of inliers; 0 if the flow is undetermined.
  double Refine(const events::LocalEvents& events, double half_window_s, Eigen::Vector2d* flow) const;

 private:
  FlowOptions options_;
  double sigma_;  // cells
  int radius_;    // cells
  int planes_;
};

}  // namespace evo::tracking
