#include "evaluation/trajectory/relative_pose_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "evaluation/trajectory/pair_selection.hpp"
#include "evaluation/trajectory/pose_differences.hpp"
#include "evo/core/error.hpp"

namespace evo::evaluation {
namespace {
PoseDifferences RelativeDifferences(std::span<const PosePair> pairs, std::span<const IndexPair> motions) {
  PoseDifferences differences;
  for (const auto& [i, j] : motions) {
    const geometry::SE3 truth = pairs[i].T_world_cam_truth.Inverse() * pairs[j].T_world_cam_truth;
    const geometry::SE3 estimate = pairs[i].T_world_cam_estimate.Inverse() * pairs[j].T_world_cam_estimate;
    const double distance = truth.translation().norm();
    // The true rotation does not change the length of the difference.
    differences.translation.push_back((estimate.translation() - truth.translation()).norm());
    differences.rotation.push_back(geometry::so3::Log(truth.rotation().conjugate() * estimate.rotation()).norm());
    differences.point_distance.push_back(std::abs(estimate.translation().norm() - distance));
    differences.true_distance.push_back(distance);
  }
  return differences;
}

geometry::Trajectory MatchedPoses(std::span<const PosePair> pairs, bool of_truth) {
  geometry::Trajectory poses;
  for (const auto& pair : pairs) {
    poses.push_back({pair.t_truth, of_truth ? pair.T_world_cam_truth : pair.T_world_cam_estimate});
  }
  return poses;
}

/// Converts motions between poses of `estimate` to indices of `pairs` and drops unmatched ones.
std::vector<IndexPair> ToPairIndices(std::span<const IndexPair> motions, const geometry::Trajectory& estimate,
                                     std::span<const PosePair> pairs) {
  constexpr auto kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> pair_index(estimate.size(), kNone);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto pose = std::ranges::lower_bound(estimate, pairs[k].t_estimate, {}, &geometry::StampedPose::t);
    pair_index[static_cast<std::size_t>(pose - estimate.begin())] = static_cast<std::uint32_t>(k);
  }
  std::vector<IndexPair> matched;
  for (const auto& [i, j] : motions) {
    if (pair_index[i] != kNone && pair_index[j] != kNone) matched.push_back({pair_index[i], pair_index[j]});
  }
  return matched;
}

}  // namespace

std::vector<RelativePoseError> ComputeRelativePoseErrors(std::span<const PosePair> pairs,
                                                         const geometry::Trajectory& estimate, bool has_stamps,
                                                         const RelativePoseErrorOptions& options) {
  const bool of_truth = options.pairs_from == "truth";
  const bool whole_estimate = options.pairs == "closest" && !of_truth;
  const geometry::Trajectory matched = MatchedPoses(pairs, of_truth);
  const geometry::Trajectory& poses = whole_estimate ? estimate : matched;
  std::vector<RelativePoseError> results;
  for (const auto& delta : ParseDeltas(options.deltas)) {
    const bool is_known = has_stamps || delta.unit != DeltaUnit::kSeconds;
    auto motions = is_known ? SelectPairs(poses, delta, options.pairs, options.tolerance) : std::vector<IndexPair>();
    if (whole_estimate) motions = ToPairIndices(motions, estimate, pairs);
    if (options.pairs == "closest") {
      for (auto& motion : motions) std::swap(motion.first, motion.second);
    }
    if (motions.empty() && options.required) {
      throw Error(ErrorKind::kNothingToDo,
                  fmt::format("no pair ({}) of the {} matched poses is {} apart; choose a smaller distance or a larger "
                              "tolerance",
                              options.pairs, pairs.size(), delta.name));
    }
    results.push_back({delta, options.pairs, Summarize(RelativeDifferences(pairs, motions), kRelativeRelations)});
  }
  return results;
}

}  // namespace evo::evaluation
