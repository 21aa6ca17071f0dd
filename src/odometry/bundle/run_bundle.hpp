#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "odometry/bundle/bundle_adjuster.hpp"
#include "odometry/bundle/final_refinement.hpp"

namespace evo::odometry {

/// The bundle adjustment of a segment with the names of its parts.
struct RunBundle {
  BundleProblem bundle;
  std::vector<std::size_t> frames;   ///< of the problem, as places in the segment
  std::vector<std::int64_t> tracks;  ///< of the problem's points; a track may be cut into several
};

/// The problem over all frames of a segment between which the image moves, as far as the budget allows: first long
/// tracks are cut shorter, then frames are left out.
RunBundle BuildRunBundle(const FinalRefinementOptions& options, const std::vector<Frame>& frames,
                         const Segment& segment);

}  // namespace evo::odometry
