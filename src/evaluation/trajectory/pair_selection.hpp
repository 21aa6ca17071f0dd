#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "evo/evaluation/delta.hpp"
#include "evo/geometry/trajectory.hpp"

namespace evo::evaluation {

/// Indices of the earlier and the later pose.
struct IndexPair {
  std::uint32_t first = 0;
  std::uint32_t second = 0;
  bool operator==(const IndexPair&) const = default;
};

/// Selects pairs of poses that are `delta` apart.
///
/// "consecutive", evo's rule: each pair begins where the previous one ended. Frames count from pose 0. Metres
/// accumulate along the path; a pair ends at the first pose that reaches delta, and the poses before the first such
/// pose form no pair. Angles accumulate between neighbours from pose 0. Seconds, which evo lacks: each pair ends at the
/// pose whose stamp is nearest to delta after its start; if that one is off by more than `tolerance` * delta (a gap),
/// the search goes on from the next pose.
///
/// "all", evo's rule: every pose begins a pair. The pair ends delta frames later; or at the later pose whose path
/// (metres) or time (seconds) is nearest to delta, if within `tolerance` * delta; or, for angles, at *every* later pose
/// whose angle to it is within `tolerance` * delta. The latter takes quadratic time, and more than ten million pairs
/// are an Error (kUsage).
///
/// "closest" (evaluate_rpe of the TUM RGB-D tools): every pose begins a pair, which ends at the pose whose frame, path,
/// accumulated angle or time is nearest to delta, however far off; the earlier of two equally near. Pairs that end at
/// the last pose are dropped, since most of them are cut short; so is a pose paired with itself, which TUM's tool
/// keeps.
///
/// All but the angles of "all" take O(n log n).
std::vector<IndexPair> SelectPairs(std::span<const geometry::StampedPose> poses, const Delta& delta,
                                   const std::string& selection, double tolerance);

}  // namespace evo::evaluation
