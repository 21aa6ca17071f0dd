#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/evaluation/alignment.hpp"
#include "evo/evaluation/evaluation_options.hpp"
#include "evo/evaluation/trajectory_errors.hpp"
#include "evo/geometry/trajectory.hpp"

namespace evo::evaluation {

/// The evaluated interval in the clock of the ground truth; a missing end is that of the ground truth.
struct EvaluationInterval {
  std::optional<TimeNs> from;
  std::optional<TimeNs> to;  ///< inclusive
};

/// Errors of the estimate under one alignment.
struct AlignedEvaluation {
  Alignment alignment;
  Similarity similarity;
  geometry::Trajectory aligned;  ///< estimated poses of the interval, in the truth's world frame and clock
  std::vector<PoseError> errors;
  ErrorSummary longitudinal, lateral, vertical, planar;
  std::vector<RelationStatistics> ape;  ///< absolute pose errors, kAbsoluteRelations
  std::vector<RelativePoseError> rpe;   ///< one for each delta
  SegmentErrors segments;

  const Statistics& Ape(PoseRelation relation) const { return Find(ape, relation); }
};

/// Errors of the estimate under all alignments.
struct Evaluation {
  bool has_stamps = true;      ///< otherwise stamps are the numbers of the poses in s
  TimeNs from = 0;             ///< start of the evaluated interval
  TimeNs to = 0;               ///< its end
  TimeNs max_gap = 0;          ///< a longer time without an estimated pose is a gap
  geometry::Trajectory truth;  ///< the true poses of the interval and the ones next to it, projected if requested
  Eigen::Vector3d up;          ///< unit vector along an axis of the truth's world frame
  double path_m = 0.0;         ///< length of the true path from the first matched pose to the last (m)
  double coverage = 0.0;       ///< ratio of the interval outside gaps, in [0, 1]; 1 without stamps
  std::int64_t gaps = 0;       ///< number of gaps, including those at the interval's start and end
  std::vector<AlignedEvaluation> alignments;
  std::optional<Nees> nees;          ///< if covariances are given
  std::vector<std::string> skipped;  ///< why an alignment or the covariances could not be evaluated
};

/// Evaluates `estimate` against `truth`, and its covariances if there are any. The NEES fits a scale if the first
/// alignment does. Throws Error: kNothingToDo if the trajectories do not overlap in time, kDegenerateAlignment as
/// FitAlignment, kUsage if files without stamps are asked for seconds.
Evaluation Evaluate(const geometry::Trajectory& truth, const geometry::Trajectory& estimate,
                    std::span<const Alignment> alignments, const EvaluationInterval& interval,
                    const EvaluationOptions& options, std::span<const geometry::StampedCovariance> covariances = {});

}  // namespace evo::evaluation
