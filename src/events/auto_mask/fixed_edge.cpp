#include "events/auto_mask/fixed_edge.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "events/auto_mask/edge_crossing.hpp"
#include "events/auto_mask/edge_search.hpp"

namespace evo::events {

namespace {

constexpr int kAround = 6;  // blocks to either side over which slope and direction of the flow are measured
constexpr double kContinuousRatio = 0.5;
constexpr double kMinEvidence = 0.2;    // over all blocks
constexpr double kMinCut = 0.85;        // over the blocks with evidence
constexpr double kMaxContinuous = 0.1;  // over the blocks with evidence
constexpr double kMaxArea = 0.5;        // of the image
constexpr int kMinParts = 2;

/// A block of an edge that structure flows to or from.
struct EdgePlace {
  int block = 0;
  int d = 0;  // within the tolerance: where the least structure passes
  bool is_into = false;
  double slope = 0.0;
  double ratio = 0.0;

  EdgeCrossing CrossingIn(const SideView& view) const {
    return is_into ? EdgeCrossing::Into(view, block, d) : EdgeCrossing::From(view, block, d);
  }
};

/// Finds the places of an edge, at most one a block.
class EdgePlaces {
 public:
  EdgePlaces(const SideView& view, const std::vector<int>& edge) : view_(view), edge_(edge) {}

  std::vector<EdgePlace> Find() const;

 private:
  int At(int block) const { return edge_[static_cast<std::size_t>(block)]; }
  bool Fits(int block) const { return At(block) + StructureFlow::kReach + EdgeSearch::kTolerance <= view_.depth; }
  int FirstAround(int block) const { return std::max(0, block - kAround); }
  int LastAround(int block) const { return std::min(view_.blocks - 1, block + kAround); }
  double Slope(int block) const {
    return static_cast<double>(At(LastAround(block)) - At(FirstAround(block))) /
           (StructureFlow::kBlock * std::max(1, LastAround(block) - FirstAround(block)));
  }
  std::optional<EdgePlace> FindAt(int block, bool is_into) const;

  const SideView& view_;
  const std::vector<int>& edge_;
};

std::vector<EdgePlace> EdgePlaces::Find() const {
  std::vector<EdgePlace> places;
  for (int block = 0; block < view_.blocks; ++block) {
    if (!Fits(block)) continue;
    auto place = FindAt(block, false);
    if (!place) place = FindAt(block, true);
    if (place) places.push_back(*place);
  }
  return places;
}

std::optional<EdgePlace> EdgePlaces::FindAt(int block, bool is_into) const {
  // The direction of the flow is noisier than its presence and changes less from block to block.
  EdgeCrossing around;
  for (int other = FirstAround(block); other <= LastAround(block); ++other) {
    if (Fits(other)) around.Add(EdgePlace{other, At(other), is_into, 0.0, 0.0}.CrossingIn(view_));
  }
  if (!around.IsOutward()) return {};
  std::optional<EdgePlace> best;
  for (int d = At(block) - EdgeSearch::kTolerance; d <= At(block) + EdgeSearch::kTolerance; ++d) {
    EdgePlace place{block, d, is_into, Slope(block), 0.0};
    const EdgeCrossing crossing = place.CrossingIn(view_);
    if (!crossing.HasStructure() || crossing.Noise() > EdgeCrossing::kMaxNoise) continue;
    place.ratio = crossing.Ratio();
    if (!best || place.ratio < best->ratio) best = place;
  }
  return best;
}

/// The places where the flow crosses the edge, for the place of the focus that leaves the fewest: the evidence must not
/// hang on the wrong one. Lines through the focus have none.
std::vector<EdgePlace> CrossedPlaces(const std::vector<EdgePlace>& places, const FocusOfExpansion& focus) {
  std::optional<std::vector<EdgePlace>> fewest;
  for (const SidePoint& point : focus.places) {
    std::vector<EdgePlace> crossed;
    std::ranges::copy_if(places, std::back_inserter(crossed),
                         [&](const EdgePlace& place) { return IsCrossed(point, place.block, place.d, place.slope); });
    if (!fewest || crossed.size() < fewest->size()) fewest = std::move(crossed);
  }
  return fewest.value_or(std::vector<EdgePlace>());
}

/// Whether no structure passes in every part with enough of it.
bool LastsInAllParts(std::span<const SideView> parts, const std::vector<EdgePlace>& places, double max_ratio) {
  int counted = 0;
  for (const SideView& part : parts) {
    EdgeCrossing sum;
    for (const EdgePlace& place : places) sum.Add(place.CrossingIn(part));
    if (!sum.HasStructure() || sum.Noise() > EdgeCrossing::kMaxNoise) continue;
    if (sum.Ratio() > max_ratio) return false;
    ++counted;
  }
  return counted >= kMinParts;
}

}  // namespace

std::optional<FixedEdge> FindFixedEdge(const SideView& view, std::span<const SideView> parts,
                                       const FocusOfExpansion& focus, const FixedEdgeCriterion& criterion) {
  FixedEdge edge{EdgeSearch(view, focus.middle).Find(), 0.0};
  const auto places = EdgePlaces(view, edge.first).Find();
  const auto crossed = CrossedPlaces(places, focus);
  const auto count = static_cast<double>(crossed.size());
  const auto cut = static_cast<double>(std::ranges::count_if(
      crossed, [&](const EdgePlace& place) { return place.ratio <= criterion.max_crossing_ratio; }));
  const auto continuous = static_cast<double>(
      std::ranges::count_if(places, [](const EdgePlace& place) { return place.ratio > kContinuousRatio; }));
  if (count < kMinEvidence * view.blocks || cut < kMinCut * count || continuous > kMaxContinuous * count ||
      !LastsInAllParts(parts, crossed, criterion.max_crossing_ratio)) {
    return {};
  }
  for (int along = 0; along < view.length; ++along) edge.area += view.depth - edge.first[view.BlockAt(along)];
  if (edge.area < criterion.min_area || edge.area > kMaxArea * view.length * view.depth) return {};
  return edge;
}

}  // namespace evo::events
