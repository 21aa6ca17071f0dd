#include "evo/evaluation/association.hpp"

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <optional>
#include <queue>
#include <tuple>
#include <utility>

#include "evo/core/error.hpp"
#include "evo/evaluation/statistics.hpp"

namespace evo {

namespace {

/// `stamps` is not empty; of two stamps equally near, the earlier.
std::size_t NearestPose(const Trajectory& trajectory, TimeNs t) {
  const auto after = std::ranges::lower_bound(trajectory, t, {}, &StampedPose::t);
  if (after == trajectory.begin()) return 0;
  const auto before = after - 1;
  const bool take_after = after != trajectory.end() && after->t - t < t - before->t;
  return static_cast<std::size_t>((take_after ? after : before) - trajectory.begin());
}

PosePair Pair(const StampedPose& truth, const StampedPose& estimate) {
  return {estimate.t, truth.t, estimate.T_world_cam, truth.T_world_cam};
}

/// The poses of one trajectory are walked, each takes the nearest of the other.
std::vector<PosePair> PairWithNearest(const Trajectory& truth, const Trajectory& estimate, bool walk_truth,
                                      TimeNs offset, TimeNs max_difference) {
  std::vector<PosePair> pairs;
  const Trajectory& walked = walk_truth ? truth : estimate;
  const Trajectory& searched = walk_truth ? estimate : truth;
  const TimeNs to_searched = walk_truth ? -offset : offset;
  for (const auto& pose : walked) {
    const auto& nearest = searched[NearestPose(searched, pose.t + to_searched)];
    if (std::abs(nearest.t - (pose.t + to_searched)) > max_difference) continue;
    pairs.push_back(walk_truth ? Pair(pose, nearest) : Pair(nearest, pose));
  }
  return pairs;
}

/// Merges the stamps of both into one row. The two nearest stamps of different kind are always neighbours in it, and
/// taking them out makes their neighbours neighbours: no other candidates need to be looked at.
std::vector<PosePair> PairUniquely(const Trajectory& truth, const Trajectory& estimate, TimeNs offset,
                                   TimeNs max_difference) {
  struct Entry {
    TimeNs t = 0;  // in the clock of the truth
    bool is_truth = false;
    const StampedPose* pose = nullptr;
    std::size_t before = 0;
    std::size_t after = 0;
    bool taken = false;
  };
  std::vector<Entry> row{{}};  // entries 0 and the last are the ends
  for (const auto& pose : truth) row.push_back({pose.t, true, &pose});
  for (const auto& pose : estimate) row.push_back({pose.t + offset, false, &pose});
  std::ranges::sort(row.begin() + 1, row.end(), {}, [](const Entry& e) { return std::pair(e.t, !e.is_truth); });
  row.push_back({});
  for (std::size_t i = 1; i + 1 < row.size(); ++i) {
    row[i].before = i - 1;
    row[i].after = i + 1;
  }
  // Difference, then the truth's stamp, then the estimate's; then the entries.
  using Candidate = std::tuple<TimeNs, TimeNs, TimeNs, std::size_t, std::size_t>;
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> candidates;
  const auto propose = [&](std::size_t i, std::size_t j) {
    if (!row[i].pose || !row[j].pose || row[i].is_truth == row[j].is_truth) return;
    const auto [of_truth, of_estimate] = row[i].is_truth ? std::pair(i, j) : std::pair(j, i);
    const TimeNs difference = std::abs(row[i].t - row[j].t);
    if (difference <= max_difference) candidates.emplace(difference, row[of_truth].t, row[of_estimate].t, i, j);
  };
  for (std::size_t i = 1; i + 1 < row.size(); ++i) propose(i, i + 1);
  std::vector<PosePair> pairs;
  for (; !candidates.empty(); candidates.pop()) {
    const auto [difference, t_truth, t_estimate, i, j] = candidates.top();
    if (row[i].taken || row[j].taken) continue;
    row[i].taken = row[j].taken = true;
    pairs.push_back(row[i].is_truth ? Pair(*row[i].pose, *row[j].pose) : Pair(*row[j].pose, *row[i].pose));
    const std::size_t before = row[i].before;
    const std::size_t after = row[j].after;
    row[before].after = after;
    row[after].before = before;
    propose(before, after);
  }
  std::ranges::sort(pairs, {}, [](const PosePair& pair) { return std::pair(pair.t_truth, pair.t_estimate); });
  return pairs;
}

std::vector<PosePair> PairByIndex(const Trajectory& truth, const Trajectory& estimate) {
  if (truth.size() != estimate.size()) {
    throw Error(ErrorKind::kInput, "files without stamps must have one pose for each frame, but the estimate has " +
                                       std::to_string(estimate.size()) + " and the ground truth " +
                                       std::to_string(truth.size()) +
                                       "; write poses for the same frames, or use files with stamps");
  }
  std::vector<PosePair> pairs;
  for (std::size_t i = 0; i < truth.size(); ++i) pairs.push_back(Pair(truth[i], estimate[i]));
  return pairs;
}

TimeNs UsualDifference(const std::string& association, const Trajectory& truth) {
  if (association == "nearest") return FromSeconds(0.01);
  if (association == "unique") return FromSeconds(0.02);
  std::vector<double> intervals;
  for (std::size_t i = 1; i < truth.size(); ++i) intervals.push_back(ToSeconds(truth[i].t - truth[i - 1].t));
  return intervals.empty() ? 0 : FromSeconds(2.0 * ComputeStatistics(intervals).median);
}

std::optional<SE3> InterpolateAt(const Trajectory& trajectory, TimeNs t, TimeNs max_interval) {
  const auto after = std::ranges::lower_bound(trajectory, t, {}, &StampedPose::t);
  if (after == trajectory.end()) return std::nullopt;
  if (after->t == t) return after->T_world_cam;
  if (after == trajectory.begin()) return std::nullopt;
  const auto before = after - 1;
  const TimeNs interval = after->t - before->t;
  if (interval > max_interval) return std::nullopt;
  return Interpolate(before->T_world_cam, after->T_world_cam, ToSeconds(t - before->t) / ToSeconds(interval));
}

std::vector<PosePair> PairWithInterpolated(const Trajectory& truth, const Trajectory& estimate, TimeNs offset,
                                           TimeNs max_interval) {
  std::vector<PosePair> pairs;
  for (const auto& pose : estimate) {
    const TimeNs t = pose.t + offset;
    const auto T_world_cam_truth = InterpolateAt(truth, t, max_interval);
    if (T_world_cam_truth) pairs.push_back({pose.t, t, pose.T_world_cam, *T_world_cam_truth});
  }
  return pairs;
}

}  // namespace

std::vector<PosePair> Associate(const Trajectory& truth, const Trajectory& estimate,
                                const AssociationOptions& options) {
  if (truth.empty() || estimate.empty()) return {};
  const std::string& association = options.association;
  if (association == "index") return PairByIndex(truth, estimate);
  const TimeNs offset = FromSeconds(options.estimate_clock_offset_s);
  if (association == "interpolate") {
    return PairWithInterpolated(truth, estimate, offset, FromSeconds(options.max_interpolation_s));
  }
  const TimeNs max_difference =
      options.max_difference_s < 0.0 ? UsualDifference(association, truth) : FromSeconds(options.max_difference_s);
  if (association == "unique") return PairUniquely(truth, estimate, offset, max_difference);
  const bool walk_truth = association == "nearest" && estimate.size() > truth.size();
  return PairWithNearest(truth, estimate, walk_truth, offset, max_difference);
}

}  // namespace evo
