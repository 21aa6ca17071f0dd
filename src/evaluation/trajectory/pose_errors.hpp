#pragma once

#include <span>
#include <vector>

#include "evo/evaluation/evaluation.hpp"

namespace evo::evaluation {

/// Distance that the truth has travelled at each pair since the first one, m: along all true poses between them.
std::vector<double> ComputeDistances(const geometry::Trajectory& truth, std::span<const PosePair> pairs);

/// `pairs` after alignment, `distances` those of ComputeDistances; of `evaluation` the interval and the up direction.
std::vector<PoseError> ComputeErrors(const geometry::Trajectory& truth, std::span<const PosePair> pairs,
                                     std::span<const double> distances, const Evaluation& evaluation,
                                     const EvaluationOptions& options);

/// `errors` holds one or more.
ErrorSummary Summarize(std::span<const PoseError> errors, double DrivingError::*component);

}  // namespace evo::evaluation
