#pragma once

#include <opencv2/core.hpp>

#include "evo/core/parallel.hpp"
#include "evo/core/time.hpp"
#include "evo/events/event_history.hpp"
#include "evo/tracking/tracker_options.hpp"
#include "tracking/detection/flow_field.hpp"

namespace evo::tracking {

/// Motion-compensated event image (the corrected event frame of D. Zhu et al., figure 2c): each event around `t` is
/// moved along the flow to the position of its edge at `t`. CV_32F, events per pixel. The window of each pixel is so
/// long that the flow moves its edge by `motion_px`, within the limits of the options.
cv::Mat MotionCompensatedImage(const events::EventHistory& history, TimeNs t, const FlowField& flow, double motion_px,
                               const TrackerOptions& options, ThreadPool* pool);

}  // namespace evo::tracking
