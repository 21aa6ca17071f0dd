#pragma once

#include <functional>
#include <vector>

#include "evo/core/parallel.hpp"
#include "evo/odometry/odometry_options.hpp"
#include "odometry/frontend/frame.hpp"
#include "odometry/segment.hpp"

namespace evo::odometry {

/// Bundle adjustment over the frames of one segment and all their tracks, then every frame's pose against the refined
/// points, also of frames in [before, after) that the tracking had not reached. The first pose and the distance of the
/// farthest stay. `frames` are all frames of the run. A track may come back as several points: long ones are cut.
void RefineSegment(const FinalRefinementOptions& options, const std::vector<Frame>& frames, int before, int after,
                   const std::function<void(double)>& progress, ThreadPool* pool, Segment* segment);

}  // namespace evo::odometry
