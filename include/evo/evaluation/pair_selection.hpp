#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "evo/geometry/trajectory.hpp"

namespace evo::evaluation {

enum class DeltaUnit { kFrames, kMetres, kDegrees, kRadians, kSeconds };

/// How far apart the two poses of a relative error are.
struct Delta {
  double value = 1.0;
  DeltaUnit unit = DeltaUnit::kFrames;
  std::string name = "1f";  ///< as written
};

/// "f", "m", "deg", "rad", "s".
const char* UnitName(DeltaUnit unit);

/// Reads a comma-separated list such as "1f,0.5s,10m,5deg,0.1rad". Deltas are positive, whole in frames and at most
/// half a turn. Error (kUsage) for anything else.
std::vector<Delta> ParseDeltas(const std::string& text);

/// Indices of the earlier and the later pose.
struct IndexPair {
  std::uint32_t first = 0;
  std::uint32_t second = 0;
  bool operator==(const IndexPair&) const = default;
};

/// `selection`: how the pairs follow one another.
///
/// "consecutive", evo's rules: one pair begins where the last one ended. Frames begin at pose 0. Metres accumulate
/// along the path; a pair ends at the first pose that reaches delta, and what comes before the first such pose belongs
/// to none. Angles accumulate between neighbours from pose 0 on. Seconds, which evo has not: from pose 0 on, each pair
/// ends at the pose whose stamp is nearest to delta after its beginning; where that one is farther off than tolerance *
/// delta (a gap) the next pose begins anew.
///
/// "all", evo's rules: every pose begins a pair. It ends delta frames later; or at the later pose whose path (metres)
/// or time (seconds) is nearest to delta, if within tolerance * delta; or, for angles, at *every* later pose whose
/// direct angle to it is within tolerance * delta, which takes time in proportion to the square of the poses;
/// more than ten million such pairs are an Error (kUsage).
///
/// "closest", as in evaluate_rpe of the TUM RGB-D tools: every pose begins a pair, which ends at the pose whose frame,
/// path, accumulated angle or time is nearest to delta, however far off, the earlier of two equally near. Pairs that
/// end at the last pose are left out, since most of them are cut short; so is a pose paired with itself, which is not
/// so there.
///
/// All but angles of "all" take O(n log n).
std::vector<IndexPair> SelectPairs(std::span<const geometry::StampedPose> poses, const Delta& delta,
                                   const std::string& selection, double tolerance);

}  // namespace evo::evaluation
