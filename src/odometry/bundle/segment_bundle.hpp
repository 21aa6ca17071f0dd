#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "evo/odometry/odometry_options.hpp"
#include "odometry/bundle/bundle_problem.hpp"
#include "odometry/frontend/frame.hpp"
#include "odometry/segment.hpp"

namespace evo::odometry {

/// The bundle adjustment of a whole segment.
struct SegmentBundle {
  BundleProblem problem;
  std::vector<std::size_t> segment_poses;  ///< index in the segment of each of the problem's poses
  std::vector<std::int64_t> track_ids;     ///< of the problem's points; a long track is cut into several points
};

/// The problem over all frames of a segment between which the image moves, within `options.max_block_products` an
/// iteration: first long tracks are cut shorter, then frames are left out.
SegmentBundle BuildSegmentBundle(const FinalRefinementOptions& options, const std::vector<Frame>& frames,
                                 const Segment& segment);

}  // namespace evo::odometry
