#pragma once

#include <span>
#include <vector>

#include "evaluation/trajectory/association.hpp"
#include "evo/evaluation/evaluation.hpp"

namespace evo::evaluation {

/// Distance along all true poses from the first pair to each pair (m).
std::vector<double> ComputeDistances(const geometry::Trajectory& truth, std::span<const PosePair> pairs);

/// Errors of aligned `pairs` at their `distances`; of `evaluation` the interval's start and the up direction are read.
std::vector<PoseError> ComputeErrors(const geometry::Trajectory& truth, std::span<const PosePair> pairs,
                                     std::span<const double> distances, const Evaluation& evaluation,
                                     const EvaluationOptions& options);

/// `errors` must not be empty.
ErrorSummary Summarize(std::span<const PoseError> errors, double PositionError::*component);

}  // namespace evo::evaluation
