#include "evo/evaluation/evaluation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "evo/core/error.hpp"

namespace evo {

namespace {

constexpr double kFirstMeters = 1.0;  // of the way, where errors by distance travelled say nothing yet

std::string Span(TimeNs from, TimeNs to) { return FormatTime(from) + " to " + FormatTime(to) + " s"; }

Trajectory Crop(const Trajectory& trajectory, TimeNs from, TimeNs to) {
  const auto first = std::ranges::lower_bound(trajectory, from, {}, &StampedPose::t);
  const auto last = std::ranges::upper_bound(trajectory, to, {}, &StampedPose::t);
  return first < last ? Trajectory(first, last) : Trajectory();
}

/// The truth of the interval and, where they are no farther than `longest_gap`, the poses just before and after it:
/// with them it reaches to where the estimate begins and ends.
Trajectory Cover(const Trajectory& truth, TimeNs from, TimeNs to, TimeNs longest_gap) {
  auto first = std::ranges::lower_bound(truth, from, {}, &StampedPose::t);
  auto last = std::ranges::upper_bound(truth, to, {}, &StampedPose::t);
  if (first != truth.begin() && from - (first - 1)->t <= longest_gap) --first;
  if (last != truth.end() && last->t - to <= longest_gap) ++last;
  return {first, last};
}

/// `estimate` with its stamps moved to the clock of the truth, cut to the interval.
Trajectory MoveToTruthClock(Trajectory estimate, TimeNs offset, TimeNs from, TimeNs to) {
  for (auto& pose : estimate) pose.t += offset;
  return Crop(estimate, from, to);
}

/// Distance that the truth has travelled at each pair since the first one, m: along all true poses between them.
std::vector<double> ComputeDistances(const Trajectory& truth, std::span<const PosePair> pairs) {
  std::vector<double> distances;
  double distance = 0.0;
  Eigen::Vector3d position = pairs.front().T_world_cam_truth.translation();
  auto next = std::ranges::upper_bound(truth, pairs.front().t_truth, {}, &StampedPose::t);
  const auto walk_to = [&](const Eigen::Vector3d& to) {
    distance += (to - position).norm();
    position = to;
  };
  for (const auto& pair : pairs) {
    for (; next != truth.end() && next->t <= pair.t_truth; ++next) walk_to(next->T_world_cam.translation());
    walk_to(pair.T_world_cam_truth.translation());
    distances.push_back(distance);
  }
  return distances;
}

struct Coverage {
  double share = 0.0;
  std::int64_t gaps = 0;
};

Coverage ComputeCoverage(std::span<const StampedPose> poses, TimeNs from, TimeNs to, TimeNs longest_gap) {
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

std::vector<PoseError> ComputeErrors(const Trajectory& truth, std::span<const PosePair> pairs,
                                     std::span<const double> distances, const Similarity& similarity,
                                     const Evaluation& evaluation, double chord) {
  DrivingFrame frame(truth, evaluation.up, chord);
  std::vector<PoseError> errors;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto& pair = pairs[i];
    const SE3& T_world_cam = pair.T_world_cam_truth;
    const SE3 aligned = similarity * pair.T_world_cam_estimate;
    PoseError error;
    error.stamp = pair.t_estimate;
    error.seconds = ToSeconds(pair.t_truth - evaluation.from);
    error.distance = distances[i];
    error.driving = frame.Split(pair.t_truth, T_world_cam.translation(), aligned.translation());
    error.translation = (aligned.translation() - T_world_cam.translation()).norm();
    error.rotation_deg =
        so3::Log(T_world_cam.rotation().conjugate() * aligned.rotation()).norm() * 180.0 / std::numbers::pi;
    errors.push_back(error);
  }
  return errors;
}

template <typename Component>
std::vector<double> Column(std::span<const PoseError> errors, const Component& component) {
  std::vector<double> column;
  for (const auto& error : errors) column.push_back(component(error));
  return column;
}

ErrorSummary Summarize(std::span<const PoseError> errors, double DrivingError::*component) {
  std::vector<double> values = Column(errors, [&](const PoseError& error) { return error.driving.*component; });
  const double final = values.back();
  for (double& value : values) value = std::abs(value);
  const Statistics statistics = ComputeStatistics(values);
  std::vector<double> shares;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (errors[i].distance >= kFirstMeters) shares.push_back(values[i] / errors[i].distance);
  }
  return {statistics.mean, statistics.rmse, statistics.max, final, ComputeStatistics(shares).mean};
}

}  // namespace

void Register(Parameters& parameters, EvaluationOptions& options) {
  auto& association = options.association;
  parameters.Add("evaluation.association", &association.association, {"interpolate", "nearest"},
                 "how an estimated pose finds its true one");
  parameters.Add("evaluation.max_interpolation_s", &association.max_interpolation_s, 0.0, 1e3,
                 "interpolate: truth poses farther apart are a hole (s)");
  parameters.Add("evaluation.max_difference_s", &association.max_difference_s, 0.0, 1e3,
                 "nearest: stamps farther apart form no pair (s)");
  parameters.Add("evaluation.estimate_clock_offset_s", &association.estimate_clock_offset_s, -1e9, 1e9,
                 "added to the estimate's stamps (s)");
  parameters.Add("evaluation.up", &options.up, {"auto", "x", "y", "z", "-x", "-y", "-z"},
                 "axis of the truth's world that points up; auto takes the one nearest to the camera's mean up");
  parameters.Add("evaluation.chord_m", &options.chord_m, 1e-3, 1e3,
                 "length of truth that gives the direction of travel (m)");
  parameters.Add("evaluation.gap_s", &options.gap_s, 1e-3, 1e3, "a longer stretch without a pose is a gap (s)");
}

Evaluation Evaluate(const Trajectory& truth, const Trajectory& estimate, std::span<const Alignment> alignments,
                    const EvaluationInterval& interval, const EvaluationOptions& options) {
  if (truth.empty() || estimate.empty()) {
    throw Error(ErrorKind::kNothingToDo, std::string(truth.empty() ? "the ground truth" : "the estimate") +
                                             " holds no poses; check what was written to it");
  }
  Evaluation evaluation;
  evaluation.longest_gap = FromSeconds(options.gap_s);
  evaluation.from = interval.from.value_or(truth.front().t);
  evaluation.to = interval.to.value_or(truth.back().t);

  std::vector<PosePair> pairs = Associate(truth, estimate, options.association);
  std::erase_if(pairs, [&](const PosePair& p) { return p.t_truth < evaluation.from || p.t_truth > evaluation.to; });
  if (pairs.empty()) {
    throw Error(ErrorKind::kNothingToDo,
                "no estimated pose has a true one: the estimate covers " + Span(estimate.front().t, estimate.back().t) +
                    ", the ground truth " + Span(truth.front().t, truth.back().t) + ", the interval judged is " +
                    Span(evaluation.from, evaluation.to) +
                    "; check that both use one clock (evaluation.estimate_clock_offset_s) and the tolerance");
  }

  const TimeNs offset = FromSeconds(options.association.estimate_clock_offset_s);
  const Trajectory judged = MoveToTruthClock(estimate, offset, evaluation.from, evaluation.to);
  const auto coverage = ComputeCoverage(judged, evaluation.from, evaluation.to, evaluation.longest_gap);
  const auto distances = ComputeDistances(truth, pairs);
  evaluation.truth = Cover(truth, evaluation.from, evaluation.to, evaluation.longest_gap);
  evaluation.up = UpDirection(options.up, truth);
  evaluation.path_m = distances.back();
  evaluation.coverage = coverage.share;
  evaluation.gaps = coverage.gaps;

  for (const auto& alignment : alignments) {
    AlignedEvaluation result;
    result.alignment = alignment;
    result.similarity = Align(pairs, alignment);
    for (const auto& pose : judged) result.aligned.push_back({pose.t, result.similarity * pose.T_world_cam});
    result.errors = ComputeErrors(truth, pairs, distances, result.similarity, evaluation, options.chord_m);
    result.longitudinal = Summarize(result.errors, &DrivingError::longitudinal);
    result.lateral = Summarize(result.errors, &DrivingError::lateral);
    result.vertical = Summarize(result.errors, &DrivingError::vertical);
    result.planar = Summarize(result.errors, &DrivingError::planar);
    result.ape = ComputeStatistics(Column(result.errors, [](const PoseError& e) { return e.translation; }));
    result.rotation_deg = ComputeStatistics(Column(result.errors, [](const PoseError& e) { return e.rotation_deg; }));
    evaluation.alignments.push_back(std::move(result));
  }
  return evaluation;
}

}  // namespace evo
