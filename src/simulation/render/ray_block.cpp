#include "simulation/render/ray_block.hpp"

#include <algorithm>

namespace evo::simulation {

RayBox RayBlock::Bounds() const {
  RayBox box{x[0], x[0], y[0], y[0]};
  for (int i = 1; i < count; ++i) {
    box.x0 = std::min(box.x0, x[i]);
    box.x1 = std::max(box.x1, x[i]);
    box.y0 = std::min(box.y0, y[i]);
    box.y1 = std::max(box.y1, y[i]);
  }
  return box;
}

void RayBlock::FindNearest(const std::vector<const SurfaceView*>& views) {
  std::fill_n(w.begin(), count, 0.0F);
  std::fill_n(hit.begin(), count, -1);
  for (int k = 0; k < static_cast<int>(views.size()); ++k) {
    const LinearForm fw = views[k]->w;
    const LinearForm fa = views[k]->aw;
    const LinearForm fb = views[k]->bw;
    for (int i = 0; i < count; ++i) {  // without branches, so that it becomes vector code
      const float inverse_depth = fw.At(x[i], y[i]);
      const float a = fa.At(x[i], y[i]);
      const float b = fb.At(x[i], y[i]);
      const float low = a < b ? a : b;
      const float high = a < b ? b : a;
      const float inside = low < inverse_depth - high ? low : inverse_depth - high;
      const float nearer = inverse_depth < limit[i] ? inverse_depth : 0.0F;
      const bool better = (inside >= 0.0F) & (nearer > w[i]);
      w[i] = better ? nearer : w[i];
      hit[i] = better ? k : hit[i];
    }
  }
}

void RayBlock::LookBehind(int from, int to, float share) {
  x[to] = x[from];
  y[to] = y[from];
  level[to] = level[from];
  limit[to] = w[from];
  through[to] = through[from] * share;
  ray[to] = ray[from];
}

std::vector<const SurfaceView*> Cull(const std::vector<SurfaceView>& views, const RayBox& rays) {
  std::vector<const SurfaceView*> kept;
  const SurfaceView* cover = nullptr;
  float cover_w = 0.0F;
  for (const SurfaceView& view : views) {
    if (!view.Meets(rays)) continue;
    kept.push_back(&view);
    if (!view.Fills(rays)) continue;
    const float w = view.w.Min(rays);
    if (w > cover_w) {
      cover = &view;
      cover_w = w;
    }
  }
  if (cover)
    std::erase_if(kept, [&](const SurfaceView* v) { return v != cover && (v->w - cover->w).Max(rays) < 0.0F; });
  return kept;
}

}  // namespace evo::simulation
