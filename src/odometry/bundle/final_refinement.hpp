#pragma once

#include <functional>
#include <vector>

#include "evo/core/parallel.hpp"
#include "evo/odometry/odometry_options.hpp"
#include "odometry/frontend/frame.hpp"
#include "odometry/segment.hpp"

namespace evo::odometry {

/// Adjusts the frames of one segment and all their tracks together, then estimates every frame's pose against the
/// refined points, also of frames in [begin_frame, end_frame) that the tracking has not reached. The first pose and the
/// distance of the farthest stay. `frames` are all frames of the run. A track may give several points: long ones are
/// cut. `progress` gets the ratio that is done; `pool` may be null.
void RefineSegment(const FinalRefinementOptions& options, const std::vector<Frame>& frames, int begin_frame,
                   int end_frame, const std::function<void(double)>& progress, ThreadPool* pool, Segment* segment);

}  // namespace evo::odometry
