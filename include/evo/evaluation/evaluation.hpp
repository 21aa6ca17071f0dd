#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "evo/core/parameters.hpp"
#include "evo/core/time.hpp"
#include "evo/evaluation/alignment.hpp"
#include "evo/evaluation/association.hpp"
#include "evo/evaluation/consistency.hpp"
#include "evo/evaluation/driving.hpp"
#include "evo/evaluation/pose_relation.hpp"
#include "evo/evaluation/relative_pose_error.hpp"
#include "evo/evaluation/segments.hpp"
#include "evo/evaluation/statistics.hpp"
#include "evo/geometry/trajectory.hpp"

namespace evo::evaluation {

struct EvaluationOptions {
  AssociationOptions association;
  RelativePoseErrorOptions rpe;
  SegmentOptions segments;
  std::string project = "none";    ///< see Project; the estimate after its alignment
  std::string up = "auto";         ///< see UpDirection
  std::string forward = "travel";  ///< see DrivingFrame
  double chord_m = 1.0;            ///< see DrivingFrame
  double gap_s = 0.5;              ///< a longer stretch without an estimated pose is a gap
  /// An alignment that the poses do not determine is left out instead of refused.
  bool leave_out_undetermined = false;
};

void Register(Parameters& parameters, EvaluationOptions& options);

/// The stretch of time to judge, in the clock of the ground truth; an end that is missing is that of the truth.
struct EvaluationInterval {
  std::optional<TimeNs> from;
  std::optional<TimeNs> to;  ///< inclusive
};

/// One pose after alignment.
struct PoseError {
  TimeNs stamp = 0;          ///< as written in the estimate
  double seconds = 0.0;      ///< since the start of the interval
  double distance = 0.0;     ///< m that the truth has travelled since the first pair
  DrivingError driving;      ///< m
  double translation = 0.0;  ///< m, in space
  double rotation_deg = 0.0;
};

/// One component of the error of position over all poses, m.
struct ErrorSummary {
  double mean_abs = 0.0;
  double rmse = 0.0;
  double max_abs = 0.0;
  double final = 0.0;  ///< at the last pose, with its sign
  /// Mean over the poses of absolute error / distance travelled so far. Poses within the first 1 m of the way are left
  /// out; NaN where there are no others.
  double mean_over_distance = 0.0;
};

/// What one alignment gives.
struct AlignedEvaluation {
  Alignment alignment;
  Similarity similarity;
  geometry::Trajectory aligned;  ///< every estimated pose of the interval, in the truth's world frame and clock
  std::vector<PoseError> errors;
  ErrorSummary longitudinal, lateral, vertical, planar;
  std::vector<RelationStatistics> ape;  ///< absolute pose errors, kAbsoluteRelations
  std::vector<RelativePoseError> rpe;   ///< one for each delta
  SegmentEvaluation segments;

  const Statistics& Ape(PoseRelation relation) const { return Find(ape, relation); }
};

struct Evaluation {
  bool has_stamps = true;  ///< else stamps are the numbers of the poses, in s
  TimeNs from = 0;         ///< the interval judged
  TimeNs to = 0;
  geometry::Trajectory truth;  ///< the truth within it and the poses next to it, projected if so wanted
  Eigen::Vector3d up;          ///< unit vector along an axis of the truth's world frame
  double path_m = 0.0;         ///< length of the truth from the first pair to the last
  double coverage = 0.0;       ///< share of the interval outside gaps, in [0, 1]; 1 without stamps
  TimeNs longest_gap = 0;      ///< a stretch of the interval without a pose that is longer is a gap
  std::int64_t gaps = 0;       ///< their number, those at the start and the end of the interval included
  std::vector<AlignedEvaluation> alignments;
  std::optional<Consistency> consistency;  ///< of the estimate with its covariances, where those are given
  /// Why, of each alignment that the poses do not determine, and of covariances that fit no pose.
  std::vector<std::string> left_out;
};

/// Judges `estimate` by `truth`, and its covariances, if there are any, by its errors: with its scale fitted if the
/// first alignment fits one. Throws Error: kNothingToDo where they do not overlap in time, kDegenerateAlignment as
/// Align does, kUsage where seconds are asked of files without stamps.
Evaluation Evaluate(const geometry::Trajectory& truth, const geometry::Trajectory& estimate,
                    std::span<const Alignment> alignments, const EvaluationInterval& interval,
                    const EvaluationOptions& options, std::span<const geometry::StampedCovariance> covariances = {});

}  // namespace evo::evaluation
