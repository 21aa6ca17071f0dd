#pragma once

#include <array>
#include <span>
#include <vector>

#include "evo/evaluation/association.hpp"
#include "evo/evaluation/statistics.hpp"

namespace evo::evaluation {

/// What of the difference between two poses (or two motions) is measured, as evo names it.
enum class PoseRelation {
  kTranslation,         ///< length of the translation, m
  kRotationDeg,         ///< angle of the rotation, degrees
  kRotationRad,         ///< the same in rad
  kRotationFrobenius,   ///< Frobenius norm of R - I: 2 sqrt(2) sin(angle / 2)
  kFull,                ///< Frobenius norm of T - I, which mixes m and rad
  kPointDistance,       ///< motions only: difference of the distances between their two points, m
  kPointDistanceRatio,  ///< motions only: the same in % of the true distance; motions without one are left out
};

inline constexpr std::array kAbsoluteRelations{PoseRelation::kTranslation, PoseRelation::kRotationDeg,
                                               PoseRelation::kRotationRad, PoseRelation::kRotationFrobenius,
                                               PoseRelation::kFull};
inline constexpr std::array kRelativeRelations{
    PoseRelation::kTranslation,       PoseRelation::kRotationDeg, PoseRelation::kRotationRad,
    PoseRelation::kRotationFrobenius, PoseRelation::kFull,        PoseRelation::kPointDistance,
    PoseRelation::kPointDistanceRatio};

/// "translation", "rotation", "rotation_frobenius", "full", "point_distance", "point_distance_ratio".
const char* QuantityName(PoseRelation relation);
/// "m", "deg", "rad", "%", or "1" for the Frobenius norms.
const char* UnitName(PoseRelation relation);

struct RelationStatistics {
  PoseRelation relation = PoseRelation::kTranslation;
  Statistics statistics;
};

/// The statistics of `relation`, which must be among them.
const Statistics& Find(std::span<const RelationStatistics> statistics, PoseRelation relation);

/// Errors of a list of poses or motions, one entry each.
struct PoseDifferences {
  std::vector<double> translation;     ///< m
  std::vector<double> rotation;        ///< rad
  std::vector<double> point_distance;  ///< m; motions only
  std::vector<double> true_distance;   ///< m; motions only
};

/// Absolute: between each true pose and its estimated one (J. Sturm et al., IROS 2012, section IV.B; over all
/// relations as in evo).
PoseDifferences AbsoluteDifferences(std::span<const PosePair> pairs);

std::vector<RelationStatistics> Summarize(const PoseDifferences& differences, std::span<const PoseRelation> relations);

}  // namespace evo::evaluation
