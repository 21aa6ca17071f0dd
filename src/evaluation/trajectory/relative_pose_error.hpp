#pragma once

#include <span>
#include <vector>

#include "evaluation/trajectory/association.hpp"
#include "evo/evaluation/evaluation_options.hpp"
#include "evo/evaluation/trajectory_errors.hpp"

namespace evo::evaluation {

/// Errors (T_i^-1 T_j)^-1 (P_i^-1 P_j) of the motions between poses of truth T and estimate P (J. Sturm et al., IROS
/// 2012, equation 2). Seconds are those of the truth's stamps; without stamps a delta in seconds has no pairs.
///
/// `pairs` holds the aligned estimate in order of time; `estimate` holds every aligned estimated pose, matched or not.
/// "closest" selects pairs from `estimate` and drops unmatched ones; as in TUM's tool, its motion goes backwards, from
/// the later pose to the earlier, which changes the translation.
std::vector<RelativePoseError> ComputeRelativePoseErrors(std::span<const PosePair> pairs,
                                                         const geometry::Trajectory& estimate, bool has_stamps,
                                                         const RelativePoseErrorOptions& options);

}  // namespace evo::evaluation
