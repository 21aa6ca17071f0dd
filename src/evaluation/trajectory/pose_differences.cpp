#include "evaluation/trajectory/pose_differences.hpp"

#include <cmath>
#include <numbers>

namespace evo::evaluation {

namespace {

double Frobenius(double angle) { return 2.0 * std::numbers::sqrt2 * std::sin(0.5 * angle); }

std::vector<double> RelationErrors(const PoseDifferences& differences, PoseRelation relation) {
  std::vector<double> errors;
  switch (relation) {
    case PoseRelation::kTranslation:
      return differences.translation;
    case PoseRelation::kRotationRad:
      return differences.rotation;
    case PoseRelation::kPointDistance:
      return differences.point_distance;
    case PoseRelation::kRotationDeg:
      for (const double angle : differences.rotation) errors.push_back(angle * 180.0 / std::numbers::pi);
      return errors;
    case PoseRelation::kRotationFrobenius:
      for (const double angle : differences.rotation) errors.push_back(Frobenius(angle));
      return errors;
    case PoseRelation::kFull:
      for (std::size_t i = 0; i < differences.rotation.size(); ++i) {
        errors.push_back(std::hypot(differences.translation[i], Frobenius(differences.rotation[i])));
      }
      return errors;
    case PoseRelation::kPointDistanceRatio:
      for (std::size_t i = 0; i < differences.point_distance.size(); ++i) {
        const double distance = differences.true_distance[i];
        if (distance > 0.0) errors.push_back(100.0 * differences.point_distance[i] / distance);
      }
      return errors;
  }
  return errors;
}

}  // namespace

PoseDifferences AbsoluteDifferences(std::span<const PosePair> pairs) {
  PoseDifferences differences;
  for (const auto& pair : pairs) {
    const geometry::SE3& truth = pair.T_world_cam_truth;
    const geometry::SE3& estimate = pair.T_world_cam_estimate;
    differences.translation.push_back((estimate.translation() - truth.translation()).norm());
    differences.rotation.push_back(geometry::so3::Log(truth.rotation().conjugate() * estimate.rotation()).norm());
  }
  return differences;
}

std::vector<RelationStatistics> Summarize(const PoseDifferences& differences, std::span<const PoseRelation> relations) {
  std::vector<RelationStatistics> statistics;
  for (const auto relation : relations) {
    statistics.push_back({relation, ComputeStatistics(RelationErrors(differences, relation))});
  }
  return statistics;
}

}  // namespace evo::evaluation
