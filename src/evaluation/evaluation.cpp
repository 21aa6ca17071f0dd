#include "evo/evaluation/evaluation.hpp"

#include <algorithm>
#include <limits>

#include "evaluation/trajectory/pose_errors.hpp"
#include "evaluation/trajectory/projection.hpp"
#include "evo/core/error.hpp"

namespace evo::evaluation {

namespace {

std::string Span(TimeNs from, TimeNs to) { return FormatTime(from) + " to " + FormatTime(to) + " s"; }

geometry::Trajectory Crop(const geometry::Trajectory& trajectory, TimeNs from, TimeNs to) {
  const auto first = std::ranges::lower_bound(trajectory, from, {}, &geometry::StampedPose::t);
  const auto last = std::ranges::upper_bound(trajectory, to, {}, &geometry::StampedPose::t);
  return first < last ? geometry::Trajectory(first, last) : geometry::Trajectory();
}

/// The truth of the interval and, where they are no farther than `longest_gap`, the poses just before and after it:
/// with them it reaches to where the estimate begins and ends.
geometry::Trajectory Cover(const geometry::Trajectory& truth, TimeNs from, TimeNs to, TimeNs longest_gap) {
  auto first = std::ranges::lower_bound(truth, from, {}, &geometry::StampedPose::t);
  auto last = std::ranges::upper_bound(truth, to, {}, &geometry::StampedPose::t);
  if (first != truth.begin() && from - (first - 1)->t <= longest_gap) --first;
  if (last != truth.end() && last->t - to <= longest_gap) ++last;
  return {first, last};
}

/// `estimate` with its stamps moved to the clock of the truth, cut to the interval.
geometry::Trajectory MoveToTruthClock(geometry::Trajectory estimate, TimeNs offset, TimeNs from, TimeNs to) {
  for (auto& pose : estimate) pose.t += offset;
  return Crop(estimate, from, to);
}

struct Coverage {
  double share = 0.0;
  std::int64_t gaps = 0;
};

Coverage ComputeCoverage(std::span<const geometry::StampedPose> poses, TimeNs from, TimeNs to, TimeNs longest_gap) {
  Coverage coverage;
  TimeNs missing = 0;
  TimeNs last = from;
  const auto visit = [&](TimeNs t) {
    if (t - last > longest_gap) {
      missing += t - last;
      ++coverage.gaps;
    }
    last = t;
  };
  for (const auto& pose : poses) visit(pose.t);
  visit(to);
  coverage.share = to > from ? 1.0 - ToSeconds(missing) / ToSeconds(to - from) : 1.0;
  return coverage;
}

/// Poses without stamps cannot be told apart by seconds. Of the usual deltas those in seconds are passed over.
void RequireNoSeconds(std::span<const Alignment> alignments, const RelativePoseErrorOptions& rpe) {
  const auto refuse = [](const std::string& what) {
    return Error(ErrorKind::kUsage, what + ": files without stamps know no seconds; count in frames or metres");
  };
  for (const auto& alignment : alignments) {
    if (alignment.first_seconds) throw refuse("alignment '" + alignment.name + "'");
  }
  for (const auto& delta : ParseDeltas(rpe.deltas)) {
    if (delta.unit == DeltaUnit::kSeconds && rpe.required) throw refuse("relative errors over '" + delta.name + "'");
  }
}

/// The pairs within the interval. Truth outside it is no partner, except to interpolate from.
std::vector<PosePair> PairWithin(const geometry::Trajectory& truth, const geometry::Trajectory& estimate,
                                 const Evaluation& evaluation, const AssociationOptions& options) {
  const bool crops = options.association != "interpolate" && evaluation.has_stamps;
  auto pairs = Associate(crops ? Crop(truth, evaluation.from, evaluation.to) : truth, estimate, options);
  std::erase_if(pairs, [&](const PosePair& p) { return p.t_truth < evaluation.from || p.t_truth > evaluation.to; });
  if (!pairs.empty()) return pairs;
  throw Error(ErrorKind::kNothingToDo,
              "no estimated pose has a true one: the estimate covers " + Span(estimate.front().t, estimate.back().t) +
                  ", the ground truth " + Span(truth.front().t, truth.back().t) + ", the interval judged is " +
                  Span(evaluation.from, evaluation.to) +
                  "; check that both use one clock (--time-offset) and the tolerance (--max-difference)");
}

/// `poses` moved by `similarity`, then laid into the plane.
geometry::Trajectory Moved(geometry::Trajectory poses, const Similarity& similarity, const std::string& plane) {
  for (auto& pose : poses) pose.T_world_cam = Project(similarity * pose.T_world_cam, plane);
  return poses;
}

std::vector<PosePair> Moved(std::vector<PosePair> pairs, const Similarity& similarity, const std::string& plane) {
  for (auto& pair : pairs) {
    pair.T_world_cam_estimate = Project(similarity * pair.T_world_cam_estimate, plane);
    pair.T_world_cam_truth = Project(pair.T_world_cam_truth, plane);
  }
  return pairs;
}

/// What all alignments have in common.
struct Comparison {
  geometry::Trajectory truth;     // projected
  geometry::Trajectory estimate;  // as it was read
  geometry::Trajectory judged;    // the estimate within the interval, in the truth's clock
  std::vector<PosePair> pairs;
  std::vector<double> distances;
};

AlignedEvaluation EvaluateAligned(const Comparison& comparison, const Alignment& alignment,
                                  const Evaluation& evaluation, const EvaluationOptions& options) {
  AlignedEvaluation result;
  result.alignment = alignment;
  result.similarity = Align(comparison.pairs, alignment, evaluation.up);
  result.aligned = Moved(comparison.judged, result.similarity, options.project);
  const auto pairs = Moved(comparison.pairs, result.similarity, options.project);
  result.errors = ComputeErrors(comparison.truth, pairs, comparison.distances, evaluation, options);
  result.longitudinal = Summarize(result.errors, &DrivingError::longitudinal);
  result.lateral = Summarize(result.errors, &DrivingError::lateral);
  result.vertical = Summarize(result.errors, &DrivingError::vertical);
  result.planar = Summarize(result.errors, &DrivingError::planar);
  result.ape = Summarize(AbsoluteDifferences(pairs), kAbsoluteRelations);
  const auto estimate = Moved(comparison.estimate, result.similarity, options.project);
  result.rpe = ComputeRelativePoseErrors(pairs, estimate, evaluation.has_stamps, options.rpe);
  result.segments =
      EvaluateSegments(MatchPath(pairs), evaluation.up, evaluation.from, evaluation.longest_gap, options.segments);
  return result;
}

bool FitsScale(Alignment::Method method) {
  using enum Alignment::Method;
  return method == kOriginScale || method == kScale || method == kSim3;
}

bool AreDeltas(const std::string& text) {
  try {
    ParseDeltas(text);
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

void Register(Parameters& parameters, EvaluationOptions& options) {
  auto& association = options.association;
  parameters.Add("evaluation.association", &association.association,
                 {"interpolate", "nearest", "unique", "nearest-truth"}, "how an estimated pose finds its true one");
  parameters.Add("evaluation.max_interpolation_s", &association.max_interpolation_s, 0.0, 1e3,
                 "interpolate: truth poses farther apart are a hole (s)");
  parameters.Add("evaluation.max_difference_s", &association.max_difference_s, -1.0, 1e3,
                 "the others: stamps farther apart form no pair (s); negative: what is usual, 0.01 for nearest, 0.02 "
                 "for unique, twice the median interval of the truth for nearest-truth");
  parameters.Add("evaluation.estimate_clock_offset_s", &association.estimate_clock_offset_s, -1e9, 1e9,
                 "added to the estimate's stamps (s)");
  parameters.Add("evaluation.project", &options.project, {"none", "xy", "xz", "yz"},
                 "plane of the truth's world to which all errors are confined");
  parameters.Add("evaluation.up", &options.up, {"auto", "x", "y", "z", "-x", "-y", "-z"},
                 "axis of the truth's world that points up; auto takes the one nearest to the camera's mean up");
  parameters.Add("evaluation.forward", &options.forward, {"travel", "body"},
                 "what longitudinal is along: the direction of travel or the true camera's view");
  parameters.Add("evaluation.chord_m", &options.chord_m, 1e-3, 1e3,
                 "length of truth that gives the direction of travel (m)");
  parameters.Add("evaluation.gap_s", &options.gap_s, 1e-3, 1e3, "a longer stretch without a pose is a gap (s)");
  parameters.Add("evaluation.rpe_deltas", &options.rpe.deltas, AreDeltas, "a list such as 1f,0.5s,10m,5deg,0.1rad",
                 "distances of the relative errors, in frames, s, m, deg or rad");
  parameters.Add("evaluation.rpe_pairs", &options.rpe.pairs, {"consecutive", "all", "closest"},
                 "which poses so far apart are compared");
  parameters.Add("evaluation.rpe_tolerance", &options.rpe.tolerance, 0.0, 1.0,
                 "how far from the distance a pair may be, as a share of it");
  parameters.Add("evaluation.rpe_pairs_from", &options.rpe.pairs_from, {"estimate", "truth"},
                 "trajectory along which the distance is measured");
  Register(parameters, options.segments);
}

Evaluation Evaluate(const geometry::Trajectory& truth, const geometry::Trajectory& estimate,
                    std::span<const Alignment> alignments, const EvaluationInterval& interval,
                    const EvaluationOptions& options, std::span<const geometry::StampedCovariance> covariances) {
  if (truth.empty() || estimate.empty()) {
    throw Error(ErrorKind::kNothingToDo, std::string(truth.empty() ? "the ground truth" : "the estimate") +
                                             " holds no poses; check what was written to it");
  }
  Evaluation evaluation;
  evaluation.has_stamps = options.association.association != "index";
  evaluation.longest_gap = evaluation.has_stamps ? FromSeconds(options.gap_s) : std::numeric_limits<TimeNs>::max();
  evaluation.from = interval.from.value_or(truth.front().t);
  evaluation.to = interval.to.value_or(truth.back().t);
  evaluation.up = UpDirection(options.up, truth);
  if (!evaluation.has_stamps) RequireNoSeconds(alignments, options.rpe);

  Comparison comparison;
  comparison.pairs = PairWithin(truth, estimate, evaluation, options.association);
  comparison.truth = Moved(truth, {}, options.project);
  comparison.estimate = estimate;
  comparison.judged = MoveToTruthClock(estimate, FromSeconds(options.association.estimate_clock_offset_s),
                                       evaluation.from, evaluation.to);
  comparison.distances = ComputeDistances(comparison.truth, Moved(comparison.pairs, {}, options.project));
  evaluation.path_m = comparison.distances.back();
  evaluation.truth = Cover(comparison.truth, evaluation.from, evaluation.to, evaluation.longest_gap);
  const auto coverage = ComputeCoverage(comparison.judged, evaluation.from, evaluation.to, evaluation.longest_gap);
  evaluation.coverage = coverage.share;
  evaluation.gaps = coverage.gaps;

  for (const auto& alignment : alignments) {
    try {
      evaluation.alignments.push_back(EvaluateAligned(comparison, alignment, evaluation, options));
    } catch (const Error& error) {
      if (!options.leave_out_undetermined || error.kind() != ErrorKind::kDegenerateAlignment) throw;
      evaluation.left_out.emplace_back(error.what());
    }
  }
  if (!covariances.empty()) {
    evaluation.consistency = MeasureConsistency(comparison.pairs, covariances, FitsScale(alignments.front().method));
    if (evaluation.consistency->pose.count == 0) {
      evaluation.consistency.reset();
      evaluation.left_out.emplace_back(
          "the covariances: none belongs to a pose that has a true one, or the certain pose has none");
    }
  }
  return evaluation;
}

}  // namespace evo::evaluation
