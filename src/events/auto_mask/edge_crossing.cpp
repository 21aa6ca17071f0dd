#include "events/auto_mask/edge_crossing.hpp"

#include <cmath>

namespace evo::events {

namespace {

constexpr double kMinSigmas = 5.0;
constexpr double kMinAgreement = 30.0;  // pairs of events
constexpr double kMinCorrelation = 0.02;
constexpr double kMinOutward = 0.05;  // over the pairs of events
constexpr double kMinNormal = 0.25;   // sine of the angle between the edge and the flow

}  // namespace

EdgeCrossing EdgeCrossing::From(const SideView& view, int block, int d) {
  EdgeCrossing crossing;
  for (int i = 1; i <= StructureFlow::kReach; ++i) crossing.across_.Add(view.Link(block, d - i));
  for (int i = 1; i <= kSideLinks; ++i) crossing.beside_.Add(view.Link(block, d - StructureFlow::kReach - i));
  return crossing;
}

EdgeCrossing EdgeCrossing::Into(const SideView& view, int block, int d) {
  EdgeCrossing crossing;
  for (int i = 1; i <= StructureFlow::kReach; ++i) crossing.across_.Add(view.Link(block, d - i));
  if (d + kSideLinks + StructureFlow::kReach > view.depth) return crossing;
  for (int i = 0; i < kSideLinks; ++i) crossing.beside_.Add(view.Link(block, d + i));
  return crossing;
}

bool EdgeCrossing::HasStructure() const {
  return beside_.agreement > kMinSigmas * std::sqrt(beside_.pairs) && beside_.agreement > kMinAgreement &&
         beside_.agreement > kMinCorrelation * beside_.pairs;
}

bool EdgeCrossing::IsOutward() const {
  return beside_.outward > kMinSigmas * std::sqrt(beside_.outward_pairs) &&
         beside_.outward > kMinOutward * beside_.outward_pairs;
}

double EdgeCrossing::Ratio() const {
  // Fast and fine structure may agree negatively, which is no less a sign that it passes.
  return std::abs(across_.agreement) / StructureFlow::kReach / (beside_.agreement / kSideLinks);
}

double EdgeCrossing::Noise() const {
  return std::sqrt(across_.pairs) / StructureFlow::kReach / (beside_.agreement / kSideLinks);
}

bool IsCrossed(const SidePoint& focus, int block, int d, double slope) {
  const double along = StructureFlow::kBlock * (block + 0.5) - focus.along;
  const double depth = d - focus.depth;
  return depth - slope * along > kMinNormal * std::hypot(1.0, slope) * std::hypot(along, depth);
}

}  // namespace evo::events
