#include "evaluation/trajectory/association.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <queue>
#include <tuple>
#include <utility>

#include "evo/core/error.hpp"
#include "evo/evaluation/statistics.hpp"

namespace evo::evaluation {

namespace {

/// The pose nearest in time, the earlier of two equally near; `trajectory` is not empty.
std::size_t NearestPose(const geometry::Trajectory& trajectory, TimeNs t) {
  const auto after = std::ranges::lower_bound(trajectory, t, {}, &geometry::StampedPose::t);
  if (after == trajectory.begin()) return 0;
  const auto before = after - 1;
  const bool take_after = after != trajectory.end() && after->t - t < t - before->t;
  return static_cast<std::size_t>((take_after ? after : before) - trajectory.begin());
}

PosePair Pair(const geometry::StampedPose& truth, const geometry::StampedPose& estimate) {
  return {estimate.t, truth.t, estimate.T_world_cam, truth.T_world_cam};
}

/// Each pose of one trajectory takes the nearest of the other.
std::vector<PosePair> PairWithNearest(const geometry::Trajectory& truth, const geometry::Trajectory& estimate,
                                      bool from_truth, TimeNs offset, TimeNs max_difference) {
  std::vector<PosePair> pairs;
  const geometry::Trajectory& source = from_truth ? truth : estimate;
  const geometry::Trajectory& target = from_truth ? estimate : truth;
  const TimeNs to_target = from_truth ? -offset : offset;
  for (const auto& pose : source) {
    const auto& nearest = target[NearestPose(target, pose.t + to_target)];
    if (std::abs(nearest.t - (pose.t + to_target)) > max_difference) continue;
    pairs.push_back(from_truth ? Pair(pose, nearest) : Pair(nearest, pose));
  }
  return pairs;
}

/// The stamps of both trajectories in one linked list in order of time. The nearest two stamps of different
/// trajectories are always neighbours in it, so after their removal only their own neighbours become a new candidate.
class StampList {
 public:
  StampList(const geometry::Trajectory& truth, const geometry::Trajectory& estimate, TimeNs offset) {
    for (const auto& pose : truth) entries_.push_back({pose.t, true, &pose, 0, 0});
    for (const auto& pose : estimate) entries_.push_back({pose.t + offset, false, &pose, 0, 0});
    std::ranges::sort(entries_.begin() + 1, entries_.end(), {},
                      [](const Entry& e) { return std::pair(e.t, !e.is_truth); });
    entries_.push_back({});
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      entries_[i].before = i - 1;  // the first entry's is never read
      entries_[i].after = i + 1;
    }
  }

  /// Removes the nearest two, then the nearest two of the rest, and so on.
  std::vector<PosePair> RemovePairs(TimeNs max_difference) {
    std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> candidates;
    const auto propose = [&](std::size_t i, std::size_t j) {
      if (!entries_[i].pose || !entries_[j].pose || entries_[i].is_truth == entries_[j].is_truth) return;
      const auto [truth, estimate] = entries_[i].is_truth ? std::pair(i, j) : std::pair(j, i);
      const TimeNs difference = entries_[j].t - entries_[i].t;
      if (difference <= max_difference) candidates.emplace(difference, entries_[truth].t, entries_[estimate].t, i, j);
    };
    for (std::size_t i = 1; i + 1 < entries_.size(); ++i) propose(i, i + 1);
    std::vector<PosePair> pairs;
    while (!candidates.empty()) {
      const auto [difference, t_truth, t_estimate, i, j] = candidates.top();
      candidates.pop();
      if (entries_[i].after != j || entries_[j].before != i) continue;  // one of them is already paired
      pairs.push_back(entries_[i].is_truth ? Pair(*entries_[i].pose, *entries_[j].pose)
                                           : Pair(*entries_[j].pose, *entries_[i].pose));
      const auto [before, after] = Remove(i, j);
      propose(before, after);
    }
    return pairs;
  }

 private:
  struct Entry {
    TimeNs t = 0;  // in the clock of the truth
    bool is_truth = false;
    const geometry::StampedPose* pose = nullptr;  // none at either end of the list
    std::size_t before = 0;
    std::size_t after = 0;
  };
  /// Difference, then the truth's stamp, then the estimate's; then the two entries.
  using Candidate = std::tuple<TimeNs, TimeNs, TimeNs, std::size_t, std::size_t>;

  /// Unlinks two neighbours and returns the entries before and after them.
  std::pair<std::size_t, std::size_t> Remove(std::size_t i, std::size_t j) {
    const std::size_t before = entries_[i].before;
    const std::size_t after = entries_[j].after;
    entries_[before].after = after;
    entries_[after].before = before;
    return {before, after};
  }

  std::vector<Entry> entries_{Entry{}};
};

std::vector<PosePair> PairUniquely(const geometry::Trajectory& truth, const geometry::Trajectory& estimate,
                                   TimeNs offset, TimeNs max_difference) {
  auto pairs = StampList(truth, estimate, offset).RemovePairs(max_difference);
  std::ranges::sort(pairs, {}, [](const PosePair& pair) { return std::pair(pair.t_truth, pair.t_estimate); });
  return pairs;
}

std::vector<PosePair> PairByIndex(const geometry::Trajectory& truth, const geometry::Trajectory& estimate) {
  if (truth.size() != estimate.size()) {
    throw Error(ErrorKind::kInput,
                fmt::format("files without stamps must have one pose for each frame, but the estimate has {} and the "
                            "ground truth {}; write poses for the same frames, or use files with stamps",
                            estimate.size(), truth.size()));
  }
  std::vector<PosePair> pairs;
  for (std::size_t i = 0; i < truth.size(); ++i) pairs.push_back(Pair(truth[i], estimate[i]));
  return pairs;
}

TimeNs DefaultMaxDifference(const std::string& association, const geometry::Trajectory& truth) {
  if (association == "nearest") return FromSeconds(0.01);
  if (association == "unique") return FromSeconds(0.02);
  std::vector<double> intervals;
  for (std::size_t i = 1; i < truth.size(); ++i) intervals.push_back(ToSeconds(truth[i].t - truth[i - 1].t));
  return intervals.empty() ? 0 : FromSeconds(2.0 * ComputeStatistics(intervals).median);
}

std::vector<PosePair> PairWithInterpolated(const geometry::Trajectory& truth, const geometry::Trajectory& estimate,
                                           TimeNs offset, TimeNs max_interval) {
  std::vector<PosePair> pairs;
  for (const auto& pose : estimate) {
    const TimeNs t = pose.t + offset;
    const auto T_world_cam_truth = geometry::PoseAt(truth, t, max_interval);
    if (T_world_cam_truth) pairs.push_back({pose.t, t, pose.T_world_cam, *T_world_cam_truth});
  }
  return pairs;
}

}  // namespace

std::vector<PosePair> Associate(const geometry::Trajectory& truth, const geometry::Trajectory& estimate,
                                const AssociationOptions& options) {
  if (truth.empty() || estimate.empty()) return {};
  const std::string& association = options.association;
  if (association == "index") return PairByIndex(truth, estimate);
  const TimeNs offset = FromSeconds(options.estimate_clock_offset_s);
  if (association == "interpolate") {
    return PairWithInterpolated(truth, estimate, offset, FromSeconds(options.max_interpolation_s));
  }
  const TimeNs max_difference =
      options.max_difference_s < 0.0 ? DefaultMaxDifference(association, truth) : FromSeconds(options.max_difference_s);
  if (association == "unique") return PairUniquely(truth, estimate, offset, max_difference);
  const bool from_truth = association == "nearest" && estimate.size() > truth.size();
  return PairWithNearest(truth, estimate, from_truth, offset, max_difference);
}

}  // namespace evo::evaluation
