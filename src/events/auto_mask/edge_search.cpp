#include "events/auto_mask/edge_search.hpp"

#include <algorithm>
#include <cmath>

#include "events/auto_mask/edge_crossing.hpp"

namespace evo::events {

namespace {

// Ranges over the depth of the view. The side of a bonnet falls off farther than the middle.
constexpr double kMaxTilt = 0.15;
constexpr double kMinBend = -0.05;
constexpr double kMaxBend = 0.45;
constexpr int kCoarseStep = 2;         // px
constexpr double kAlongWeight = 0.15;  // of structure that does not cross the edge, but ends at it

}  // namespace

EdgeSearch::EdgeSearch(const SideView& view, const SidePoint& focus)
    : focus_(focus),
      blocks_(view.blocks),
      depth_(view.depth),
      scores_(static_cast<std::size_t>(view.blocks) * static_cast<std::size_t>(view.depth)) {
  for (int block = 0; block < blocks_; ++block) {
    for (int d = kFirstDepth; d + StructureFlow::kReach <= depth_; ++d) {
      scores_[static_cast<std::size_t>(block * depth_ + d)] = ScoreAt(view, block, d);
    }
  }
}

EdgeSearch::Score EdgeSearch::ScoreAt(const SideView& view, int block, int d) {
  EdgeCrossing crossing = EdgeCrossing::From(view, block, d);
  if (!crossing.HasStructure() || !crossing.IsOutward()) crossing = EdgeCrossing::Into(view, block, d);
  if (!crossing.HasStructure()) return {};
  const double weight = std::min(1.0, EdgeCrossing::kMaxNoise / std::max(1e-9, crossing.Noise()));
  return {static_cast<float>(weight * std::clamp(0.5 - crossing.Ratio(), -0.5, 0.5)), crossing.IsOutward()};
}

EdgeSearch::Score EdgeSearch::BestNear(int block, int d, int tolerance) const {
  Score best{-1.0F, false};
  for (int near = std::max(d - tolerance, kFirstDepth); near <= std::min(d + tolerance, depth_ - 1); ++near) {
    const Score& score = scores_[static_cast<std::size_t>(block * depth_ + near)];
    if (score.value > best.value) best = score;
  }
  return best.value == -1.0F ? Score() : best;
}

double EdgeSearch::Sum(const Curve& curve, int tolerance) const {
  const double half_length = 0.5 * StructureFlow::kBlock * blocks_;
  double sum = 0.0;
  for (int block = 0; block < blocks_; ++block) {
    const double u = Along(block);
    const int d = static_cast<int>(std::lround(curve.Depth(u)));
    if (d < kFirstDepth) return 0.0;
    const Score score = BestNear(block, d, tolerance);
    if (score.value == 0.0F) continue;
    const double slope = (curve.tilt + 2.0 * curve.bend * u) / half_length;
    const bool counts = score.is_outward && IsCrossed(focus_, block, d, slope);
    sum += counts ? score.value : kAlongWeight * score.value;
  }
  return sum;
}

EdgeSearch::Best EdgeSearch::FindIn(const Range& range, int tolerance) const {
  Best best{{static_cast<double>(depth_), 0.0, 0.0}, 0.0};
  const auto steps = [](double from, double to, double step) { return static_cast<int>((to - from) / step) + 1; };
  const int offsets = steps(range.from.offset, range.to.offset, range.step.offset);
  const int tilts = steps(range.from.tilt, range.to.tilt, range.step.tilt);
  const int bends = steps(range.from.bend, range.to.bend, range.step.bend);
  for (int i = 0; i < offsets * tilts * bends; ++i) {
    const int offset = i / (tilts * bends);
    const int tilt = i / bends % tilts;
    const int bend = i % bends;
    const Curve curve{range.from.offset + offset * range.step.offset, range.from.tilt + tilt * range.step.tilt,
                      range.from.bend + bend * range.step.bend};
    const double score = Sum(curve, tolerance);
    if (score > best.score) best = {curve, score};
  }
  return best;
}

std::vector<int> EdgeSearch::Find() const {
  const double depth = depth_;
  const Curve coarse = FindIn({{kFirstDepth, -kMaxTilt * depth, kMinBend * depth},
                               {depth - 1.0, kMaxTilt * depth, kMaxBend * depth},
                               {kCoarseStep, 2.0 * kCoarseStep, 2.0 * kCoarseStep}},
                              kCoarseStep)
                           .curve;
  const Curve fine = FindIn({{coarse.offset - 3.0, coarse.tilt - 5.0, coarse.bend - 5.0},
                             {coarse.offset + 3.0, coarse.tilt + 5.0, coarse.bend + 5.0},
                             {1.0, 1.0, 1.0}},
                            kTolerance)
                         .curve;
  std::vector<int> edge;
  for (int block = 0; block < blocks_; ++block) {
    edge.push_back(std::clamp(static_cast<int>(std::lround(fine.Depth(Along(block)))), kFirstDepth, depth_));
  }
  return edge;
}

}  // namespace evo::events
