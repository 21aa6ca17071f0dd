#include "evo/evaluation/pair_selection.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>
#include <utility>

#include "evo/core/error.hpp"

namespace evo::evaluation {

namespace {

constexpr std::size_t kMostPairs = 10'000'000;  // half a gigabyte with their errors

constexpr std::pair<const char*, DeltaUnit> kUnits[] = {{"f", DeltaUnit::kFrames},
                                                        {"m", DeltaUnit::kMetres},
                                                        {"deg", DeltaUnit::kDegrees},
                                                        {"rad", DeltaUnit::kRadians},
                                                        {"s", DeltaUnit::kSeconds}};

Delta ParseDelta(const std::string& text) {
  Delta delta;
  const char* const end = text.data() + text.size();
  const auto [suffix, failure] = std::from_chars(text.data(), end, delta.value);
  const auto* const unit = std::ranges::find(kUnits, std::string(suffix, end), [](const auto& u) { return u.first; });
  if (failure == std::errc() && unit != std::end(kUnits)) {
    delta.unit = unit->second;
    delta.name = text;
    const double largest = delta.unit == DeltaUnit::kDegrees   ? 180.0
                           : delta.unit == DeltaUnit::kRadians ? std::numbers::pi
                                                               : 1e6;
    const bool whole = delta.unit != DeltaUnit::kFrames || delta.value == std::floor(delta.value);
    if (delta.value > 0.0 && delta.value <= largest && whole) return delta;
  }
  throw Error(ErrorKind::kUsage, "'" + text +
                                     "' is not a distance between poses; give a positive number and a unit, such as "
                                     "10f (whole frames), 1s, 10m, 5deg or 0.1rad, up to half a turn");
}

/// From each pose to the next: frames, m, rad or s.
std::vector<double> Steps(std::span<const geometry::StampedPose> poses, DeltaUnit unit) {
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

/// The sum of all steps up to each pose: never decreasing.
std::vector<double> Accumulate(std::span<const double> steps) {
  std::vector<double> course{0.0};
  course.reserve(steps.size() + 1);
  for (const double step : steps) course.push_back(course.back() + step);
  return course;
}

IndexPair Pair(std::size_t first, std::size_t second) {
  return {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(second)};
}

/// Of the entries after `i`, which must exist, the one nearest to delta ahead; the first of several.
std::size_t NearestAfter(std::span<const double> course, std::size_t i, double delta) {
  const auto ahead = [&](double value) { return value - course[i]; };
  const auto later = course.subspan(i + 1);
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

std::vector<IndexPair> EveryPose(std::span<const double> course, double delta, double largest_difference) {
  std::vector<IndexPair> pairs;
  for (std::size_t i = 0; i + 1 < course.size(); ++i) {
    const std::size_t j = NearestAfter(course, i, delta);
    if (std::abs(course[j] - course[i] - delta) <= largest_difference) pairs.push_back(Pair(i, j));
  }
  return pairs;
}

std::vector<IndexPair> Closest(std::span<const double> course, double delta) {
  auto pairs = EveryPose(course, delta, std::numeric_limits<double>::infinity());
  std::erase_if(pairs, [&](const IndexPair& pair) { return pair.second + 1 == course.size(); });
  return pairs;
}

/// A pair ends where the steps since the last end sum up to delta. `from_start`: pose 0 counts as an end.
std::vector<IndexPair> EndToEnd(std::span<const double> steps, double delta, bool from_start) {
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

std::vector<IndexPair> EndToEndInTime(std::span<const double> seconds, double delta, double tolerance) {
  std::vector<IndexPair> pairs;
  for (std::size_t i = 0; i + 1 < seconds.size();) {
    const std::size_t j = NearestAfter(seconds, i, delta);
    const bool found = std::abs(seconds[j] - seconds[i] - delta) <= tolerance * delta;
    if (found) pairs.push_back(Pair(i, j));
    i = found ? j : i + 1;
  }
  return pairs;
}

/// All pairs whose rotation is between two angles, rad.
std::vector<IndexPair> ByDirectAngle(std::span<const geometry::StampedPose> poses, double lowest, double highest) {
  std::vector<IndexPair> pairs;
  // |q1 . q2| is the cosine of half the angle.
  const double largest_cosine = lowest > 0.0 ? std::cos(0.5 * lowest) : 2.0;
  const double least_cosine = std::cos(0.5 * std::min(highest, std::numbers::pi));
  for (std::size_t i = 0; i < poses.size(); ++i) {
    for (std::size_t j = i + 1; j < poses.size(); ++j) {
      const double cosine = std::abs(poses[i].T_world_cam.rotation().dot(poses[j].T_world_cam.rotation()));
      if (cosine >= least_cosine && cosine <= largest_cosine) pairs.push_back(Pair(i, j));
    }
    if (pairs.size() > kMostPairs) {
      throw Error(ErrorKind::kUsage, "more than " + std::to_string(kMostPairs) +
                                         " pairs of poses are turned by about this angle; choose --rpe-pairs "
                                         "consecutive, a smaller evaluation.rpe_tolerance or a shorter interval");
    }
  }
  return pairs;
}

}  // namespace

const char* UnitName(DeltaUnit unit) {
  return std::ranges::find(kUnits, unit, [](const auto& u) { return u.second; })->first;
}

std::vector<Delta> ParseDeltas(const std::string& text) {
  std::vector<Delta> deltas;
  std::istringstream list(text);
  for (std::string name; std::getline(list, name, ',');) {
    const Delta delta = ParseDelta(name);
    if (std::ranges::find(deltas, name, &Delta::name) == deltas.end()) deltas.push_back(delta);
  }
  if (deltas.empty()) throw Error(ErrorKind::kUsage, "no distance between poses given; for example 1f,1s,10m");
  return deltas;
}

std::vector<IndexPair> SelectPairs(std::span<const geometry::StampedPose> poses, const Delta& delta,
                                   const std::string& selection, double tolerance) {
  const bool is_angle = delta.unit == DeltaUnit::kDegrees || delta.unit == DeltaUnit::kRadians;
  const double value = delta.unit == DeltaUnit::kDegrees ? delta.value * std::numbers::pi / 180.0 : delta.value;
  const double allowed = tolerance * value;
  if (selection == "all" && is_angle) return ByDirectAngle(poses, value - allowed, value + allowed);
  const auto steps = Steps(poses, delta.unit);
  const bool is_consecutive = selection == "consecutive";
  if (is_consecutive && delta.unit != DeltaUnit::kSeconds) {
    return EndToEnd(steps, value, delta.unit != DeltaUnit::kMetres);
  }
  const auto course = Accumulate(steps);
  if (is_consecutive) return EndToEndInTime(course, value, tolerance);
  if (selection == "closest") return Closest(course, value);
  return EveryPose(course, value, delta.unit == DeltaUnit::kFrames ? 0.0 : allowed);
}

}  // namespace evo::evaluation
