#pragma once

#include <array>
#include <span>

#include "evo/evaluation/statistics.hpp"

namespace evo::evaluation {

/// The part of the difference between two poses or two motions that an error measures, in evo's terms.
enum class PoseRelation {
  kTranslation,         ///< length of the translation (m)
  kRotationDeg,         ///< angle of the rotation (degrees)
  kRotationRad,         ///< angle of the rotation (rad)
  kRotationFrobenius,   ///< Frobenius norm of R - I, 2 sqrt(2) sin(angle / 2)
  kFull,                ///< Frobenius norm of T - I, which mixes m and rad
  kPointDistance,       ///< motions only: difference of the distances between start and end (m)
  kPointDistanceRatio,  ///< motions only: kPointDistance over the true distance (%); undefined without motion
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

/// The statistics of `relation`, which must be in the list.
const Statistics& Find(std::span<const RelationStatistics> statistics, PoseRelation relation);

}  // namespace evo::evaluation
