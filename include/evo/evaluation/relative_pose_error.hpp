#pragma once

#include <span>
#include <string>
#include <vector>

#include "evo/evaluation/association.hpp"
#include "evo/evaluation/pair_selection.hpp"
#include "evo/evaluation/pose_relation.hpp"

namespace evo::evaluation {

struct RelativePoseErrorOptions {
  std::string deltas = "1f,1s,10m";     ///< see ParseDeltas
  std::string pairs = "consecutive";    ///< or "all", "closest": see SelectPairs
  double tolerance = 0.1;               ///< share of the delta
  std::string pairs_from = "estimate";  ///< the trajectory along which delta is measured, or "truth"
  bool required = false;                ///< a delta without pairs is an Error (kNothingToDo)
};

/// The errors of the motion between poses that are `delta` apart; without pairs the count is 0, the rest NaN.
struct RelativePoseError {
  Delta delta;
  std::string pairs;
  std::vector<RelationStatistics> relations;  ///< kRelativeRelations
};

/// Of each motion the difference (T_i^-1 T_j)^-1 (P_i^-1 P_j) of truth T and estimate P (J. Sturm et al., IROS 2012,
/// equation 2). Seconds are those of the truth's stamps. `pairs` holds the aligned estimate, in order of time;
/// `estimate` every aligned estimated pose, with or without a true one: "closest" looks for pairs there, as TUM's tool
/// does, and leaves out those without truth; as there, the motion is taken backwards, from the later pose to the
/// earlier, which changes its translation. Without stamps a delta in seconds has no pairs.
std::vector<RelativePoseError> ComputeRelativePoseErrors(std::span<const PosePair> pairs,
                                                         const geometry::Trajectory& estimate, bool has_stamps,
                                                         const RelativePoseErrorOptions& options);

}  // namespace evo::evaluation
