#include <algorithm>
#include <cmath>
#include <vector>

#include "events/auto_mask/fixed_edge.hpp"

namespace evo::events {

namespace {

constexpr int kTile = 8;  // px
constexpr double kMinSigmas = 4.0;
constexpr double kMinOutward = 0.05;   // over the pairs of events
constexpr std::size_t kMinTiles = 60;  // whose motion is known
constexpr double kMinAway = 0.95;      // of the tiles
constexpr double kSlack = 0.006;       // of the tiles: a place that agrees with as many less may be the focus
constexpr double kBorder = 0.12;       // of the image: a focus in it may be the end of a motion to one side

/// The motion of a tile: a direction, the length has no unit.
struct Motion {
  double x = 0.0;  // px, centre of the tile
  double y = 0.0;
  double right = 0.0;  // unit vector
  double down = 0.0;
};

/// What moves outwards over what moves at all, for each tile along the depth of `view`; 0 if it is not known.
double OutwardRatio(const SideView& view, int tile, int depth_tile) {
  constexpr int kBlocks = kTile / StructureFlow::kBlock;
  LinkFlow sum;
  for (int block = tile * kBlocks; block < std::min(view.blocks, (tile + 1) * kBlocks); ++block) {
    for (int i = 0; i < kTile; ++i) sum.Add(view.Link(block, depth_tile * kTile + i));
  }
  return std::abs(sum.outward) < kMinSigmas * std::sqrt(sum.outward_pairs) ? 0.0 : sum.outward / sum.outward_pairs;
}

std::vector<Motion> Motions(const StructureFlow& flow) {
  const SideView right = flow.From(ImageSide::kRight);
  const SideView bottom = flow.From(ImageSide::kBottom);
  std::vector<Motion> motions;
  for (int j = 0; (j + 1) * kTile <= flow.height(); ++j) {
    for (int i = 0; (i + 1) * kTile <= flow.width(); ++i) {
      const double u = OutwardRatio(right, j, i);
      const double v = OutwardRatio(bottom, i, j);
      const double length = std::hypot(u, v);
      if (length > kMinOutward) motions.push_back({(i + 0.5) * kTile, (j + 0.5) * kTile, u / length, v / length});
    }
  }
  return motions;
}

/// Whether the motion, of which an edge shows the part normal to itself alone, is one away from the focus.
bool IsAwayFrom(const Motion& motion, double x, double y) {
  return (motion.x - x) * motion.right + (motion.y - y) * motion.down > 0.0;
}

}  // namespace

std::optional<FocusOfExpansion> FindFocusOfExpansion(const StructureFlow& flow, std::string* reason) {
  const auto motions = Motions(flow);
  if (motions.size() < kMinTiles) {
    *reason = "too little of the image moves";
    return {};
  }
  struct Candidate {
    SidePoint place;
    double away = 0.0;
  };
  std::vector<Candidate> candidates;
  double most = 0.0;
  const auto count = static_cast<double>(motions.size());
  for (double y = 0.5 * kTile; y < flow.height(); y += kTile) {
    for (double x = 0.5 * kTile; x < flow.width(); x += kTile) {
      const auto away = static_cast<double>(
          std::ranges::count_if(motions, [&](const Motion& motion) { return IsAwayFrom(motion, x, y); }));
      candidates.push_back({{x, y}, away});
      most = std::max(most, away);
    }
  }
  FocusOfExpansion focus;
  for (const auto& [place, away] : candidates) {
    if (away < most - kSlack * count) continue;
    focus.places.push_back(place);
    focus.middle.along += place.along;
    focus.middle.depth += place.depth;
  }
  focus.middle.along /= static_cast<double>(focus.places.size());
  focus.middle.depth /= static_cast<double>(focus.places.size());
  const auto is_inside = [](double position, double size) {
    return position > kBorder * size && position < (1.0 - kBorder) * size;
  };
  if (most < kMinAway * count || !is_inside(focus.middle.along, flow.width()) ||
      !is_inside(focus.middle.depth, flow.height())) {
    *reason = "the scene does not move as before a camera that looks ahead while it drives";
    return {};
  }
  return focus;
}

}  // namespace evo::events
