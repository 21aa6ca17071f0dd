#include "evo/evaluation/evaluation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "evaluation/trajectory/alignment_fit.hpp"
#include "evaluation/trajectory/association.hpp"
#include "evaluation/trajectory/matched_trajectory.hpp"
#include "evaluation/trajectory/nees.hpp"
#include "evaluation/trajectory/path_frame.hpp"
#include "evaluation/trajectory/pose_differences.hpp"
#include "evaluation/trajectory/pose_errors.hpp"
#include "evaluation/trajectory/projection.hpp"
#include "evaluation/trajectory/relative_pose_error.hpp"
#include "evaluation/trajectory/segments.hpp"
#include "evo/core/error.hpp"

namespace evo::evaluation {

namespace {

std::string FormatInterval(TimeNs from, TimeNs to) { return FormatTime(from) + " to " + FormatTime(to) + " s"; }

geometry::Trajectory Crop(const geometry::Trajectory& trajectory, TimeNs from, TimeNs to) {
  const auto first = std::ranges::lower_bound(trajectory, from, {}, &geometry::StampedPose::t);
  const auto last = std::ranges::upper_bound(trajectory, to, {}, &geometry::StampedPose::t);
  return first < last ? geometry::Trajectory(first, last) : geometry::Trajectory();
}

/// The truth of the interval and the poses just before and after it, if they are within `max_gap`, so that it reaches
/// to the start and the end of the estimate.
geometry::Trajectory CropWithNeighbours(const geometry::Trajectory& truth, TimeNs from, TimeNs to, TimeNs max_gap) {
  auto first = std::ranges::lower_bound(truth, from, {}, &geometry::StampedPose::t);
  auto last = std::ranges::upper_bound(truth, to, {}, &geometry::StampedPose::t);
  if (first != truth.begin() && from - (first - 1)->t <= max_gap) --first;
  if (last != truth.end() && last->t - to <= max_gap) ++last;
  return {first, last};
}

/// The estimate of the interval with stamps in the clock of the truth.
geometry::Trajectory MoveToTruthClock(geometry::Trajectory estimate, TimeNs offset, TimeNs from, TimeNs to) {
  for (auto& pose : estimate) pose.t += offset;
  return Crop(estimate, from, to);
}

struct Coverage {
  double ratio = 0.0;
  std::int64_t gaps = 0;
};

Coverage ComputeCoverage(std::span<const geometry::StampedPose> poses, TimeNs from, TimeNs to, TimeNs max_gap) {
  Coverage coverage;
  TimeNs missing = 0;
  TimeNs last = from;
  const auto visit = [&](TimeNs t) {
    if (t - last > max_gap) {
      missing += t - last;
      ++coverage.gaps;
    }
    last = t;
  };
  for (const auto& pose : poses) visit(pose.t);
  visit(to);
  coverage.ratio = to > from ? 1.0 - ToSeconds(missing) / ToSeconds(to - from) : 1.0;
  return coverage;
}

/// Files without stamps have no seconds. Deltas in seconds are ignored unless the user asked for them.
void RequireNoSeconds(std::span<const Alignment> alignments, const RelativePoseErrorOptions& rpe) {
  const auto refuse = [](const std::string& what) {
    return Error(ErrorKind::kUsage, what + ": files without stamps have no seconds; use frames or metres");
  };
  for (const auto& alignment : alignments) {
    if (alignment.first_seconds) throw refuse("alignment '" + alignment.name + "'");
  }
  for (const auto& delta : ParseDeltas(rpe.deltas)) {
    if (delta.unit == DeltaUnit::kSeconds && rpe.required) throw refuse("relative errors over '" + delta.name + "'");
  }
}

/// Pairs within the interval. True poses outside it are used for interpolation only.
std::vector<PosePair> AssociateWithin(const geometry::Trajectory& truth, const geometry::Trajectory& estimate,
                                      const Evaluation& evaluation, const AssociationOptions& options) {
  const bool crops = options.association != "interpolate" && evaluation.has_stamps;
  auto pairs = Associate(crops ? Crop(truth, evaluation.from, evaluation.to) : truth, estimate, options);
  std::erase_if(pairs, [&](const PosePair& p) { return p.t_truth < evaluation.from || p.t_truth > evaluation.to; });
  if (!pairs.empty()) return pairs;
  throw Error(
      ErrorKind::kNothingToDo,
      fmt::format("no estimated pose has a true one: the estimate covers {}, the ground truth {}, the evaluated "
                  "interval is {}; check that both use one clock (--time-offset) and the tolerance "
                  "(--max-difference)",
                  FormatInterval(estimate.front().t, estimate.back().t),
                  FormatInterval(truth.front().t, truth.back().t), FormatInterval(evaluation.from, evaluation.to)));
}

/// Aligns poses, then projects them.
geometry::Trajectory AlignPoses(geometry::Trajectory poses, const Similarity& similarity, const std::string& plane) {
  for (auto& pose : poses) pose.T_world_cam = Project(similarity * pose.T_world_cam, plane);
  return poses;
}

std::vector<PosePair> AlignPairs(std::vector<PosePair> pairs, const Similarity& similarity, const std::string& plane) {
  for (auto& pair : pairs) {
    pair.T_world_cam_estimate = Project(similarity * pair.T_world_cam_estimate, plane);
    pair.T_world_cam_truth = Project(pair.T_world_cam_truth, plane);
  }
  return pairs;
}

/// Input that all alignments share.
struct MatchedInput {
  geometry::Trajectory truth;               // projected
  geometry::Trajectory estimate;            // as read
  geometry::Trajectory estimate_in_window;  // the estimate of the interval in the clock of the truth
  std::vector<PosePair> pairs;
  std::vector<double> distances;  // of each pair
};

AlignedEvaluation EvaluateAligned(const MatchedInput& input, const Alignment& alignment, const Evaluation& evaluation,
                                  const EvaluationOptions& options) {
  AlignedEvaluation result;
  result.alignment = alignment;
  result.similarity = FitAlignment(input.pairs, alignment, evaluation.up);
  result.aligned = AlignPoses(input.estimate_in_window, result.similarity, options.project);
  const auto pairs = AlignPairs(input.pairs, result.similarity, options.project);
  result.errors = ComputeErrors(input.truth, pairs, input.distances, evaluation, options);
  result.longitudinal = Summarize(result.errors, &PositionError::longitudinal);
  result.lateral = Summarize(result.errors, &PositionError::lateral);
  result.vertical = Summarize(result.errors, &PositionError::vertical);
  result.planar = Summarize(result.errors, &PositionError::planar);
  result.ape = Summarize(AbsoluteDifferences(pairs), kAbsoluteRelations);
  const auto estimate = AlignPoses(input.estimate, result.similarity, options.project);
  result.rpe = ComputeRelativePoseErrors(pairs, estimate, evaluation.has_stamps, options.rpe);
  result.segments = EvaluateSegments(BuildMatchedTrajectory(pairs), evaluation.up, evaluation.from, evaluation.max_gap,
                                     options.segments);
  return result;
}

bool FitsScale(Alignment::Method method) {
  using enum Alignment::Method;
  return method == kOriginScale || method == kScale || method == kSim3;
}

/// Everything about the interval that does not depend on the input's pairs.
Evaluation StartEvaluation(const geometry::Trajectory& truth, const EvaluationInterval& interval,
                           const EvaluationOptions& options) {
  Evaluation evaluation;
  evaluation.has_stamps = options.association.association != "index";
  evaluation.max_gap = evaluation.has_stamps ? FromSeconds(options.gap_s) : std::numeric_limits<TimeNs>::max();
  evaluation.from = interval.from.value_or(truth.front().t);
  evaluation.to = interval.to.value_or(truth.back().t);
  evaluation.up = UpDirection(options.up, truth);
  return evaluation;
}

MatchedInput MatchInput(const geometry::Trajectory& truth, const geometry::Trajectory& estimate,
                        const Evaluation& evaluation, const EvaluationOptions& options) {
  MatchedInput input;
  input.pairs = AssociateWithin(truth, estimate, evaluation, options.association);
  input.truth = AlignPoses(truth, {}, options.project);
  input.estimate = estimate;
  input.estimate_in_window = MoveToTruthClock(estimate, FromSeconds(options.association.estimate_clock_offset_s),
                                              evaluation.from, evaluation.to);
  input.distances = ComputeDistances(input.truth, AlignPairs(input.pairs, {}, options.project));
  return input;
}

}  // namespace

Evaluation Evaluate(const geometry::Trajectory& truth, const geometry::Trajectory& estimate,
                    std::span<const Alignment> alignments, const EvaluationInterval& interval,
                    const EvaluationOptions& options, std::span<const geometry::StampedCovariance> covariances) {
  if (truth.empty() || estimate.empty()) {
    throw Error(ErrorKind::kNothingToDo,
                fmt::format("the {} holds no poses; check the file", truth.empty() ? "ground truth" : "estimate"));
  }
  Evaluation evaluation = StartEvaluation(truth, interval, options);
  if (!evaluation.has_stamps) RequireNoSeconds(alignments, options.rpe);
  const MatchedInput input = MatchInput(truth, estimate, evaluation, options);
  evaluation.path_m = input.distances.back();
  evaluation.truth = CropWithNeighbours(input.truth, evaluation.from, evaluation.to, evaluation.max_gap);
  const auto coverage = ComputeCoverage(input.estimate_in_window, evaluation.from, evaluation.to, evaluation.max_gap);
  evaluation.coverage = coverage.ratio;
  evaluation.gaps = coverage.gaps;

  for (const auto& alignment : alignments) {
    try {
      evaluation.alignments.push_back(EvaluateAligned(input, alignment, evaluation, options));
    } catch (const Error& error) {
      if (!options.skip_degenerate_alignments || error.kind() != ErrorKind::kDegenerateAlignment) throw;
      evaluation.skipped.emplace_back(error.what());
    }
  }
  if (!covariances.empty()) {
    const Nees nees = ComputeNees(input.pairs, covariances, FitsScale(alignments.front().method));
    if (nees.pose.count > 0) {
      evaluation.nees = nees;
    } else {
      evaluation.skipped.emplace_back(
          "covariances: none belongs to a matched pose, or no matched pose is their origin");
    }
  }
  return evaluation;
}

}  // namespace evo::evaluation
