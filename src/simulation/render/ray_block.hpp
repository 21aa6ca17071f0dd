#pragma once

#include <array>
#include <vector>

#include "evo/simulation/surface_tree.hpp"
#include "simulation/render/surface_view.hpp"

namespace evo::simulation {

/// Some neighbouring rays that are traced together: few enough for the nearest cache, many enough for vectors.
struct RayBlock {
  static constexpr int kSize = 256;

  int count = 0;
  std::array<float, kSize> x, y;
  std::array<float, kSize> level;    ///< log2 of the distance of neighbouring rays on the plane z = 1
  std::array<float, kSize> limit;    ///< only what has a smaller inverse depth counts
  std::array<float, kSize> through;  ///< share of the light that what is nearer lets pass
  std::array<int, kSize> ray;        ///< index of the ray in the block as it was at first
  std::array<float, kSize> w;        ///< inverse depth of the nearest hit
  std::array<int, kSize> hit;        ///< its index in the views, -1: none

  RayBox Bounds() const;
  /// Fills in `w` and `hit`.
  void FindNearest(const std::vector<const SurfaceView*>& views);
  /// Moves ray `from` to place `to` so that it sees what is behind its hit.
  void LookBehind(int from, int to, float share);
};

/// Those views that rays of the box can hit and that nothing solid in front covers wholly.
std::vector<const SurfaceView*> Cull(const std::vector<SurfaceView>& views, const RayBox& rays);

/// Follows the rays through the holes of what they hit, from near to far. `take(i, surface)` is told that ray i of the
/// block hit `views[surface]`, or nothing (-1), and gives the share of light that passes; below 1/256 the ray ends.
template <typename Take>
void Walk(const std::vector<const SurfaceView*>& views, RayBlock* block, const Take& take) {
  constexpr float kDark = 1.0F / 256.0F;
  while (block->count > 0) {
    block->FindNearest(views);
    int kept = 0;
    for (int i = 0; i < block->count; ++i) {
      const float share = take(i, block->hit[i]);
      if (block->hit[i] >= 0 && share * block->through[i] > kDark) block->LookBehind(i, kept++, share);
    }
    block->count = kept;
  }
}

}  // namespace evo::simulation
