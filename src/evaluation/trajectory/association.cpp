#include "evo/evaluation/association.hpp"

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

/// `stamps` is not empty; of two stamps equally near, the earlier.
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

/// The poses of one trajectory are walked, each takes the nearest of the other.
std::vector<PosePair> PairWithNearest(const geometry::Trajectory& truth, const geometry::Trajectory& estimate,
                                      bool walk_truth, TimeNs offset, TimeNs max_difference) {
  std::vector<PosePair> pairs;
  const geometry::Trajectory& walked = walk_truth ? truth : estimate;
  const geometry::Trajectory& searched = walk_truth ? estimate : truth;
  const TimeNs to_searched = walk_truth ? -offset : offset;
  for (const auto& pose : walked) {
    const auto& nearest = searched[NearestPose(searched, pose.t + to_searched)];
    if (std::abs(nearest.t - (pose.t + to_searched)) > max_difference) continue;
    pairs.push_back(walk_truth ? Pair(pose, nearest) : Pair(nearest, pose));
  }
  return pairs;
}

/// The stamps of both trajectories in one row. The two nearest stamps of different kind are always neighbours in it,
/// and taking them out makes their neighbours neighbours: no other candidates need to be looked at.
class StampRow {
 public:
  StampRow(const geometry::Trajectory& truth, const geometry::Trajectory& estimate, TimeNs offset) {
    for (const auto& pose : truth) row_.push_back({pose.t, true, &pose, 0, 0});
    for (const auto& pose : estimate) row_.push_back({pose.t + offset, false, &pose, 0, 0});
    std::ranges::sort(row_.begin() + 1, row_.end(), {}, [](const Entry& e) { return std::pair(e.t, !e.is_truth); });
    row_.push_back({});
    for (std::size_t i = 0; i < row_.size(); ++i) {
      row_[i].before = i - 1;  // of the first end never asked for
      row_[i].after = i + 1;
    }
  }

  /// Takes the nearest two, then the nearest of the rest, and so on.
  std::vector<PosePair> TakePairs(TimeNs max_difference) {
    std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> candidates;
    const auto propose = [&](std::size_t i, std::size_t j) {
      if (!row_[i].pose || !row_[j].pose || row_[i].is_truth == row_[j].is_truth) return;
      const auto [truth, estimate] = row_[i].is_truth ? std::pair(i, j) : std::pair(j, i);
      const TimeNs difference = row_[j].t - row_[i].t;
      if (difference <= max_difference) candidates.emplace(difference, row_[truth].t, row_[estimate].t, i, j);
    };
    for (std::size_t i = 1; i + 1 < row_.size(); ++i) propose(i, i + 1);
    std::vector<PosePair> pairs;
    while (!candidates.empty()) {
      const auto [difference, t_truth, t_estimate, i, j] = candidates.top();
      candidates.pop();
      if (row_[i].after != j || row_[j].before != i) continue;  // one is taken: no neighbours any more
      pairs.push_back(row_[i].is_truth ? Pair(*row_[i].pose, *row_[j].pose) : Pair(*row_[j].pose, *row_[i].pose));
      const auto [before, after] = Remove(i, j);
      propose(before, after);
    }
    return pairs;
  }

 private:
  struct Entry {
    TimeNs t = 0;  // in the clock of the truth
    bool is_truth = false;
    const geometry::StampedPose* pose = nullptr;  // none at either end of the row
    std::size_t before = 0;
    std::size_t after = 0;
  };
  /// Difference, then the truth's stamp, then the estimate's; then the two entries.
  using Candidate = std::tuple<TimeNs, TimeNs, TimeNs, std::size_t, std::size_t>;

  /// Makes the neighbours of two neighbours neighbours and gives them.
  std::pair<std::size_t, std::size_t> Remove(std::size_t i, std::size_t j) {
    const std::size_t before = row_[i].before;
    const std::size_t after = row_[j].after;
    row_[before].after = after;
    row_[after].before = before;
    return {before, after};
  }

  std::vector<Entry> row_{Entry{}};
};

std::vector<PosePair> PairUniquely(const geometry::Trajectory& truth, const geometry::Trajectory& estimate,
                                   TimeNs offset, TimeNs max_difference) {
  auto pairs = StampRow(truth, estimate, offset).TakePairs(max_difference);
  std::ranges::sort(pairs, {}, [](const PosePair& pair) { return std::pair(pair.t_truth, pair.t_estimate); });
  return pairs;
}

std::vector<PosePair> PairByIndex(const geometry::Trajectory& truth, const geometry::Trajectory& estimate) {
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

TimeNs UsualDifference(const std::string& association, const geometry::Trajectory& truth) {
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
      options.max_difference_s < 0.0 ? UsualDifference(association, truth) : FromSeconds(options.max_difference_s);
  if (association == "unique") return PairUniquely(truth, estimate, offset, max_difference);
  const bool walk_truth = association == "nearest" && estimate.size() > truth.size();
  return PairWithNearest(truth, estimate, walk_truth, offset, max_difference);
}

}  // namespace evo::evaluation
