#pragma once

#include <span>
#include <vector>

#include "evaluation/trajectory/association.hpp"
#include "evo/evaluation/pose_relation.hpp"

namespace evo::evaluation {

/// Differences of a list of poses or motions, one entry each.
struct PoseDifferences {
  std::vector<double> translation;     ///< m
  std::vector<double> rotation;        ///< rad
  std::vector<double> point_distance;  ///< m; motions only
  std::vector<double> true_distance;   ///< m; motions only
};

/// Differences between each true pose and its estimate (J. Sturm et al., IROS 2012, section IV.B; relations as in evo).
PoseDifferences AbsoluteDifferences(std::span<const PosePair> pairs);

std::vector<RelationStatistics> Summarize(const PoseDifferences& differences, std::span<const PoseRelation> relations);

}  // namespace evo::evaluation
