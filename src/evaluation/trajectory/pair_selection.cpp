#include "evaluation/trajectory/pair_selection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "evo/core/error.hpp"

namespace evo::evaluation {

namespace {

constexpr std::size_t kMaxPairs = 10'000'000;  // half a gigabyte with their errors

/// Distance from each pose to the next (frames, m, rad or s).
std::vector<double> StepLengths(std::span<const geometry::StampedPose> poses, DeltaUnit unit) {
  std::vector<double> steps;
  steps.reserve(poses.size());
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const geometry::SE3& before = poses[i - 1].T_world_cam;
    const geometry::SE3& after = poses[i].T_world_cam;
    switch (unit) {
      case DeltaUnit::kFrames:
        steps.push_back(1.0);
        break;
      case DeltaUnit::kSeconds:
        steps.push_back(ToSeconds(poses[i].t - poses[i - 1].t));
        break;
      case DeltaUnit::kMetres:
        steps.push_back((after.translation() - before.translation()).norm());
        break;
      default:
        steps.push_back(geometry::so3::Log(before.rotation().conjugate() * after.rotation()).norm());
    }
  }
  return steps;
}

/// Sum of all steps up to each pose, which never decreases.
std::vector<double> Accumulate(std::span<const double> steps) {
  std::vector<double> cumulative{0.0};
  cumulative.reserve(steps.size() + 1);
  for (const double step : steps) cumulative.push_back(cumulative.back() + step);
  return cumulative;
}

IndexPair Pair(std::size_t first, std::size_t second) {
  return {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(second)};
}

/// Index of the entry after `i` that is nearest to `delta` ahead, the first of several; there must be entries after
/// `i`.
std::size_t NearestAfter(std::span<const double> cumulative, std::size_t i, double delta) {
  const auto ahead = [&](double value) { return value - cumulative[i]; };
  const auto later = cumulative.subspan(i + 1);
  const auto reached = std::ranges::lower_bound(later, delta, {}, ahead);
  auto best = reached;
  if (reached != later.begin()) {
    const double before = ahead(*(reached - 1));
    if (reached == later.end() || delta - before <= ahead(*reached) - delta) {
      best = std::ranges::lower_bound(later.begin(), reached, before, {}, ahead);
    }
  }
  return i + 1 + static_cast<std::size_t>(best - later.begin());
}

std::vector<IndexPair> PairsFromEveryPose(std::span<const double> cumulative, double delta, double max_difference) {
  std::vector<IndexPair> pairs;
  for (std::size_t i = 0; i + 1 < cumulative.size(); ++i) {
    const std::size_t j = NearestAfter(cumulative, i, delta);
    if (std::abs(cumulative[j] - cumulative[i] - delta) <= max_difference) pairs.push_back(Pair(i, j));
  }
  return pairs;
}

std::vector<IndexPair> ClosestPairs(std::span<const double> cumulative, double delta) {
  auto pairs = PairsFromEveryPose(cumulative, delta, std::numeric_limits<double>::infinity());
  std::erase_if(pairs, [&](const IndexPair& pair) { return pair.second + 1 == cumulative.size(); });
  return pairs;
}

/// Ends a pair where the steps since the last end add up to delta. `from_start`: pose 0 counts as an end.
std::vector<IndexPair> ConsecutivePairs(std::span<const double> steps, double delta, bool from_start) {
  std::vector<IndexPair> pairs;
  bool begun = from_start;
  std::size_t begin = 0;
  double sum = 0.0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    sum += steps[i];
    if (sum < delta) continue;
    if (begun) pairs.push_back(Pair(begin, i + 1));
    begun = true;
    begin = i + 1;
    sum = 0.0;
  }
  return pairs;
}

std::vector<IndexPair> ConsecutivePairsInTime(std::span<const double> seconds, double delta, double tolerance) {
  std::vector<IndexPair> pairs;
  for (std::size_t i = 0; i + 1 < seconds.size();) {
    const std::size_t j = NearestAfter(seconds, i, delta);
    const bool found = std::abs(seconds[j] - seconds[i] - delta) <= tolerance * delta;
    if (found) pairs.push_back(Pair(i, j));
    i = found ? j : i + 1;
  }
  return pairs;
}

/// All pairs whose relative rotation is within [min_angle, max_angle] (rad).
std::vector<IndexPair> PairsByAngle(std::span<const geometry::StampedPose> poses, double min_angle, double max_angle) {
  std::vector<IndexPair> pairs;
  // |q1 . q2| is the cosine of half the angle.
  const double max_cosine = min_angle > 0.0 ? std::cos(0.5 * min_angle) : 2.0;
  const double min_cosine = std::cos(0.5 * std::min(max_angle, std::numbers::pi));
  for (std::size_t i = 0; i < poses.size(); ++i) {
    for (std::size_t j = i + 1; j < poses.size(); ++j) {
      const double cosine = std::abs(poses[i].T_world_cam.rotation().dot(poses[j].T_world_cam.rotation()));
      if (cosine >= min_cosine && cosine <= max_cosine) pairs.push_back(Pair(i, j));
    }
    if (pairs.size() > kMaxPairs) {
      throw Error(ErrorKind::kUsage,
                  fmt::format("more than {} pairs of poses differ by about this angle; choose --rpe-pairs consecutive, "
                              "a smaller evaluation.rpe_tolerance or a shorter interval",
                              kMaxPairs));
    }
  }
  return pairs;
}

}  // namespace

std::vector<IndexPair> SelectPairs(std::span<const geometry::StampedPose> poses, const Delta& delta,
                                   const std::string& selection, double tolerance) {
  const bool is_angle = delta.unit == DeltaUnit::kDegrees || delta.unit == DeltaUnit::kRadians;
  const double value = delta.unit == DeltaUnit::kDegrees ? delta.value * std::numbers::pi / 180.0 : delta.value;
  const double allowed = tolerance * value;
  if (selection == "all" && is_angle) return PairsByAngle(poses, value - allowed, value + allowed);
  const auto steps = StepLengths(poses, delta.unit);
  const bool is_consecutive = selection == "consecutive";
  if (is_consecutive && delta.unit != DeltaUnit::kSeconds) {
    return ConsecutivePairs(steps, value, delta.unit != DeltaUnit::kMetres);
  }
  const auto cumulative = Accumulate(steps);
  if (is_consecutive) return ConsecutivePairsInTime(cumulative, value, tolerance);
  if (selection == "closest") return ClosestPairs(cumulative, value);
  return PairsFromEveryPose(cumulative, value, delta.unit == DeltaUnit::kFrames ? 0.0 : allowed);
}

}  // namespace evo::evaluation
