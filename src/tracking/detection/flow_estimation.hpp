#pragma once

#include <Eigen/Core>

#include "evo/core/time.hpp"
#include "evo/events/event_history.hpp"
#include "evo/tracking/tracker_options.hpp"

namespace evo::tracking {

/// Estimates the flow (px/s) of the events around `position` (px) at `t`, by EM 1 of A. Z. Zhu et al. over windows of
/// growing length, each started from the flow of the one before; the first starts from `flow`, which may be zero.
/// Returns false if there are too few events.
bool EstimateCoarseFlow(const events::EventHistory& history, TimeNs t, const Eigen::Vector2d& position,
                        const TrackerOptions& options, Eigen::Vector2d* flow);

/// Estimates a coarse flow, then refines it on the smaller patch of a feature.
bool EstimateFlow(const events::EventHistory& history, TimeNs t, const Eigen::Vector2d& position,
                  const TrackerOptions& options, Eigen::Vector2d* flow);

}  // namespace evo::tracking
