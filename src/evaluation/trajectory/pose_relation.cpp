#include "evo/evaluation/pose_relation.hpp"

#include <algorithm>

namespace evo::evaluation {

const char* QuantityName(PoseRelation relation) {
  switch (relation) {
    case PoseRelation::kTranslation:
      return "translation";
    case PoseRelation::kRotationDeg:
    case PoseRelation::kRotationRad:
      return "rotation";
    case PoseRelation::kRotationFrobenius:
      return "rotation_frobenius";
    case PoseRelation::kFull:
      return "full";
    case PoseRelation::kPointDistance:
      return "point_distance";
    case PoseRelation::kPointDistanceRatio:
      return "point_distance_ratio";
  }
  return "";
}

const char* UnitName(PoseRelation relation) {
  switch (relation) {
    case PoseRelation::kTranslation:
    case PoseRelation::kPointDistance:
      return "m";
    case PoseRelation::kRotationDeg:
      return "deg";
    case PoseRelation::kRotationRad:
      return "rad";
    case PoseRelation::kPointDistanceRatio:
      return "%";
    default:
      return "1";
  }
}

const Statistics& Find(std::span<const RelationStatistics> statistics, PoseRelation relation) {
  return std::ranges::find(statistics, relation, &RelationStatistics::relation)->statistics;
}

}  // namespace evo::evaluation
