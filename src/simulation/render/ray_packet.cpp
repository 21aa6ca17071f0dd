#include "simulation/render/ray_packet.hpp"

#include <algorithm>

namespace evo::simulation {

RayFrustum RayPacket::Frustum() const {
  RayFrustum bounds{x[0], x[0], y[0], y[0]};
  for (int i = 1; i < count; ++i) {
    bounds.x0 = std::min(bounds.x0, x[i]);
    bounds.x1 = std::max(bounds.x1, x[i]);
    bounds.y0 = std::min(bounds.y0, y[i]);
    bounds.y1 = std::max(bounds.y1, y[i]);
  }
  return bounds;
}

void RayPacket::FindNearestHits(const std::vector<const ProjectedSurface*>& surfaces) {
  std::fill_n(inverse_depth.begin(), count, 0.0F);
  std::fill_n(hit.begin(), count, -1);
  for (int k = 0; k < static_cast<int>(surfaces.size()); ++k) {
    const LinearForm w_form = surfaces[k]->inverse_depth;
    const LinearForm a_form = surfaces[k]->a_over_depth;
    const LinearForm b_form = surfaces[k]->b_over_depth;
    for (int i = 0; i < count; ++i) {  // without branches: vector code
      const float w = w_form.Evaluate(x[i], y[i]);
      const float a = a_form.Evaluate(x[i], y[i]);
      const float b = b_form.Evaluate(x[i], y[i]);
      const float low = a < b ? a : b;
      const float high = a < b ? b : a;
      const float inside = low < w - high ? low : w - high;
      const float behind = w < max_inverse_depth[i] ? w : 0.0F;
      const bool nearer = (inside >= 0.0F) & (behind > inverse_depth[i]);
      inverse_depth[i] = nearer ? behind : inverse_depth[i];
      hit[i] = nearer ? k : hit[i];
    }
  }
}

void RayPacket::ContinueBehind(int from, int to, float transmittance_of_hit) {
  x[to] = x[from];
  y[to] = y[from];
  log2_spacing[to] = log2_spacing[from];
  max_inverse_depth[to] = inverse_depth[from];
  transmittance[to] = transmittance[from] * transmittance_of_hit;
  ray[to] = ray[from];
}

std::vector<const ProjectedSurface*> CullOccluded(const std::vector<ProjectedSurface>& surfaces,
                                                  const RayFrustum& rays) {
  std::vector<const ProjectedSurface*> kept;
  const ProjectedSurface* occluder = nullptr;
  float occluder_inverse_depth = 0.0F;
  for (const ProjectedSurface& surface : surfaces) {
    if (!surface.Intersects(rays)) continue;
    kept.push_back(&surface);
    if (!surface.Covers(rays)) continue;
    const float inverse_depth = surface.inverse_depth.Min(rays);
    if (inverse_depth > occluder_inverse_depth) {
      occluder = &surface;
      occluder_inverse_depth = inverse_depth;
    }
  }
  if (occluder) {
    std::erase_if(kept, [&](const ProjectedSurface* surface) {
      return surface != occluder && (surface->inverse_depth - occluder->inverse_depth).Max(rays) < 0.0F;
    });
  }
  return kept;
}

}  // namespace evo::simulation
