#include "tracking/detection/flow_estimation.hpp"

#include <algorithm>
#include <cstddef>

#include "tracking/event_window.hpp"
#include "tracking/patch/em_flow.hpp"

namespace evo::tracking {

namespace {

// A coarse flow costs a quarter with these, and is exact enough to start from or to compensate an image with.
constexpr double kCoarseCellPx = 2.0;
constexpr double kCoarseConvergencePx = 0.1;
constexpr double kFineCellPx = 1.0;
constexpr double kFineConvergencePx = 0.02;
constexpr int kHistogramMarginPx = 2;  // events of a patch that a wrong flow moves beyond its edge

FlowEstimator MakeEstimator(int radius_px, double cell_px, double sigma_px, double convergence_px,
                            const TrackerOptions& options) {
  return {radius_px + kHistogramMarginPx,
          options.use_polarity ? 2 : 1,
          {cell_px, sigma_px, options.outlier_density_ratio, options.iterations, convergence_px}};
}

/// False if the patch holds too few events for a flow.
bool GatherForFlow(const events::EventHistory& history, const events::MovingPatch& patch, const TrackerOptions& options,
                   events::LocalEvents* events) {
  history.Gather(patch, events);
  events->Subsample(static_cast<std::size_t>(options.max_events));
  return events->size() >= static_cast<std::size_t>(options.min_events);
}

events::MovingPatch MakePatch(TimeNs t, const Eigen::Vector2d& position, const Eigen::Vector2d& flow, int radius_px,
                              TimeNs half_window) {
  return {t, position.x(), position.y(), flow.x(), flow.y(), static_cast<double>(radius_px), half_window};
}

}  // namespace

bool EstimateCoarseFlow(const events::EventHistory& history, TimeNs t, const Eigen::Vector2d& position,
                        const TrackerOptions& options, Eigen::Vector2d* flow) {
  thread_local events::LocalEvents events;
  // An unknown flow hardly moves the events of a short window, which in turn tells little of a slow flow. Each window
  // of twice the length starts from a flow of half the error, until the events have moved far enough.
  const int radius_px = options.flow_patch_radius_px;
  const FlowEstimator estimator =
      MakeEstimator(radius_px, kCoarseCellPx, options.flow_sigma_px, kCoarseConvergencePx, options);
  const TimeNs max_half_window = FromSeconds(0.5 * options.max_window_s);
  TimeNs half_window =
      flow->isZero() ? FromSeconds(0.5 * options.min_window_s) : HalfWindow(*flow, options.window_motion_px, options);
  bool is_found = false;
  for (bool is_last = false; !is_last; half_window *= 2) {
    half_window = std::min(half_window, max_half_window);
    is_last = half_window == max_half_window;
    if (!GatherForFlow(history, MakePatch(t, position, *flow, radius_px, half_window), options, &events)) continue;
    if (!(estimator.Refine(events, ToSeconds(half_window), flow) > 0.0)) return false;
    is_found = true;
    is_last = is_last || flow->norm() * 2.0 * ToSeconds(half_window) >= options.window_motion_px;
  }
  return is_found;
}

bool EstimateFlow(const events::EventHistory& history, TimeNs t, const Eigen::Vector2d& position,
                  const TrackerOptions& options, Eigen::Vector2d* flow) {
  if (!EstimateCoarseFlow(history, t, position, options, flow)) return false;
  // The patch of a feature is smaller, as its surroundings may have another depth.
  thread_local events::LocalEvents events;
  const int radius_px = options.patch_radius_px;
  const FlowEstimator estimator =
      MakeEstimator(radius_px, kFineCellPx, options.fine_sigma_px, kFineConvergencePx, options);
  TimeNs half_window = HalfWindow(*flow, options.window_motion_px, options);
  if (!GatherForFlow(history, MakePatch(t, position, *flow, radius_px, half_window), options, &events)) {
    half_window = DoubledHalfWindow(half_window, options);
    if (!GatherForFlow(history, MakePatch(t, position, *flow, radius_px, half_window), options, &events)) return false;
  }
  return estimator.Refine(events, ToSeconds(half_window), flow) > 0.0;
}

}  // namespace evo::tracking
