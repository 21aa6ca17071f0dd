#include "evo/simulation/renderer.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "evo/core/error.hpp"
#include "simulation/render/ray_block.hpp"
#include "simulation/render/surface_view.hpp"
#include "simulation/world/lights.hpp"

namespace evo::simulation {

using Eigen::Vector2d;

namespace {

constexpr int kMostSamples = 16;  // a pixel's rays must fit into one block

/// Where the rays of a pixel lie across the columns (or rows) of their grid, in [0, 1), by its places `along` and
/// `across` an edge between columns (or rows): van der Corput's sequence along it, which no slope of the edge follows.
double RaysShift(int along, int across) {
  constexpr double kGolden = 0.6180339887498949;
  double shift = kGolden * across;
  for (double digit = 0.5; along > 0; along /= 2, digit /= 2.0) shift += digit * (along % 2);
  return shift - std::floor(shift);
}

/// Cuts a tile into parts of which each fits into a block of rays.
template <typename Use>
void ForEachPart(const Tile& tile, int rays_per_pixel, const Use& use) {
  const int side = static_cast<int>(std::sqrt(RayBlock::kSize / rays_per_pixel));
  for (int y = 0; y < tile.height; y += side) {
    for (int x = 0; x < tile.width; x += side) {
      use(Tile{tile.x0 + x, tile.y0 + y, std::min(side, tile.width - x), std::min(side, tile.height - y)});
    }
  }
}

float TextureLevel(const SurfaceView& view, const RayBlock& block, int i, float depth) {
  return view.level + 1.5F * QuickLog2(depth) + block.level[i];
}

Texture::Sample LookUp(const SurfaceView& view, const RayBlock& block, int i, float depth) {
  return view.texture->AtLevel(view.uw.At(block.x[i], block.y[i]) * depth, view.vw.At(block.x[i], block.y[i]) * depth,
                               TextureLevel(view, block, i, depth));
}

/// Radiance that comes along each ray of a block, by the parts of Renderer::Radiance.
struct AlongRays {
  std::array<float, RayBlock::kSize> steady;
  std::array<float, RayBlock::kSize> lamps;
  bool lit = false;  ///< `lamps` is not all 0
};

void Shade(const std::vector<SurfaceView>& views, const Lights& lights, float sky, RayBlock* block, AlongRays* along) {
  const RayBox box = block->Bounds();
  const auto seen = Cull(views, box);
  std::vector<Lights::OnSurface> shining;
  along->lit = false;
  for (const SurfaceView* view : seen) {
    if (!lights.any()) break;
    shining.push_back(lights.For(*view, box));
    along->lit = along->lit || !shining.back().lamps.empty();
  }
  std::fill_n(along->steady.begin(), block->count, 0.0F);
  std::fill_n(along->lamps.begin(), block->count, 0.0F);
  Walk(seen, block, [&](int i, int surface) {
    const int ray = block->ray[i];
    if (surface < 0) {
      along->steady[ray] += block->through[i] * sky;
      return 0.0F;
    }
    const SurfaceView& view = *seen[surface];
    const float depth = 1.0F / block->w[i];
    const Texture::Sample sample = LookUp(view, *block, i, depth);
    const float reflected = block->through[i] * sample.reflected;
    float light = view.light;
    if (!shining.empty()) light += HeadLampLight(shining[surface], block->x[i], block->y[i], depth);
    if (along->lit) along->lamps[ray] += reflected * StreetLampLight(shining[surface], block->x[i], block->y[i], depth);
    along->steady[ray] += reflected * light + block->through[i] * sample.coverage * view.emission;
    return 1.0F - sample.coverage;
  });
}

float MeanOf(const float* rays, int count) {
  float sum = 0.0F;
  for (int k = 0; k < count; ++k) sum += rays[k];
  return sum / static_cast<float>(count);
}

}  // namespace

std::vector<Tile> CutIntoTiles(int width, int height, int size) {
  std::vector<Tile> tiles;
  for (int y = 0; y < height; y += size) {
    for (int x = 0; x < width; x += size) {
      tiles.push_back({x, y, std::min(size, width - x), std::min(size, height - y)});
    }
  }
  return tiles;
}

Renderer::Renderer(const Scene& scene, const geometry::Camera& camera, int samples)
    : scene_(scene),
      camera_(camera),
      tree_(scene),
      blind_(static_cast<std::size_t>(camera.width()) * static_cast<std::size_t>(camera.height())) {
  if (samples < 1 || samples > kMostSamples) {
    throw Error(ErrorKind::kInput, "renderer: samples must lie in [1, 16], not " + std::to_string(samples));
  }
  centres_ = CastRays(1);
  samples_ = samples == 1 ? centres_ : CastRays(samples);
}

Renderer::Rays Renderer::CastRays(int samples) {
  Rays rays;
  rays.per_pixel = samples * samples;
  Vector2d ray = Vector2d::Zero();  // where there is none the last one stands in
  for (int p = 0; p < camera_.width() * camera_.height(); ++p) {
    const Vector2d centre(p % camera_.width(), p / camera_.width());
    const double shift_x = samples == 1 ? 0.5 : RaysShift(p / camera_.width(), p % camera_.width());
    const double shift_y = samples == 1 ? 0.5 : RaysShift(p % camera_.width(), p / camera_.width());
    for (int j = 0; j < samples; ++j) {
      for (int i = 0; i < samples; ++i) {
        const Vector2d place((i + (j + shift_x) / samples) / samples,
                             (j + (samples - 1 - i + shift_y) / samples) / samples);
        const auto found = camera_.Undistort(centre + place - Vector2d(0.5, 0.5));
        if (found) ray = *found;
        if (!found) blind_[p] = 1;
        rays.x.push_back(static_cast<float>(ray.x()));
        rays.y.push_back(static_cast<float>(ray.y()));
      }
    }
    // One pixel is |det of the lens model's inverse| large on the plane z = 1, seen from the ray at hand.
    constexpr double kStep = 1e-4;
    Eigen::Matrix2d step;
    for (int c = 0; c < 2; ++c) {
      step.col(c) = (camera_.Distort(ray + kStep * Vector2d::Unit(c)) - camera_.Distort(ray)) / kStep;
    }
    const double pixels2 = std::max(std::abs(step.determinant()), 1.0);
    rays.level.push_back(static_cast<float>(-0.5 * std::log2(pixels2) - std::log2(samples)));
  }
  return rays;
}

Renderer::Visible Renderer::FindVisible(const Tile& tile, TimeNs from, TimeNs to, const geometry::SE3& T_world_cam_from,
                                        const geometry::SE3& T_world_cam_to) const {
  RayBox box = Bounds(tile);
  const float pixel = std::exp2(*std::max_element(centres_.level.begin(), centres_.level.end()));
  box = {box.x0 - pixel, box.x1 + pixel, box.y0 - pixel, box.y1 + pixel};
  return {tree_.Find(box, from, to, T_world_cam_from, T_world_cam_to)};
}

RayBox Renderer::Bounds(const Tile& tile) const {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  RayBox box{kFar, -kFar, kFar, -kFar};
  for (int y = tile.y0; y < tile.y0 + tile.height; ++y) {
    const int first = (y * camera_.width() + tile.x0) * samples_.per_pixel;
    for (int i = first; i < first + tile.width * samples_.per_pixel; ++i) {
      box.x0 = std::min(box.x0, samples_.x[i]);
      box.x1 = std::max(box.x1, samples_.x[i]);
      box.y0 = std::min(box.y0, samples_.y[i]);
      box.y1 = std::max(box.y1, samples_.y[i]);
    }
  }
  return box;
}

void Renderer::Gather(const Rays& rays, const Tile& part, RayBlock* block) const {
  int n = 0;
  for (int y = part.y0; y < part.y0 + part.height; ++y) {
    for (int x = part.x0; x < part.x0 + part.width; ++x) {
      const int pixel = y * camera_.width() + x;
      for (int k = 0; k < rays.per_pixel; ++k, ++n) {
        block->x[n] = rays.x[pixel * rays.per_pixel + k];
        block->y[n] = rays.y[pixel * rays.per_pixel + k];
        block->level[n] = rays.level[pixel];
        block->ray[n] = n;
      }
    }
  }
  block->count = n;
  std::fill_n(block->limit.begin(), n, std::numeric_limits<float>::infinity());
  std::fill_n(block->through.begin(), n, 1.0F);
}

void Renderer::Render(const Tile& tile, const Visible& visible, TimeNs t, const geometry::SE3& T_world_cam,
                      Radiance* radiance) const {
  const auto views = Viewer(scene_, t, T_world_cam).Views(visible.surfaces, Bounds(tile));
  const Lights lights(scene_.lighting, T_world_cam);
  const int n = samples_.per_pixel;
  const auto pixels = static_cast<std::size_t>(tile.width) * static_cast<std::size_t>(tile.height);
  radiance->steady.assign(pixels, 0.0F);
  radiance->lamps.assign(pixels, 0.0F);
  radiance->lit = false;
  RayBlock block;
  AlongRays along;
  ForEachPart(tile, n, [&](const Tile& part) {
    Gather(samples_, part, &block);
    Shade(views, lights, static_cast<float>(scene_.lighting.sky), &block, &along);
    radiance->lit = radiance->lit || along.lit;
    for (int p = 0; p < part.width * part.height; ++p) {
      const int x = part.x0 + p % part.width;
      const int y = part.y0 + p / part.width;
      if (blind_[y * camera_.width() + x] != 0) continue;
      const int place = (y - tile.y0) * tile.width + x - tile.x0;
      radiance->steady[place] = MeanOf(&along.steady[p * n], n);
      if (along.lit) radiance->lamps[place] = MeanOf(&along.lamps[p * n], n);
    }
  });
}

void Renderer::Depth(const Tile& tile, const Visible& visible, TimeNs t, const geometry::SE3& T_world_cam,
                     std::span<float> depth, std::span<std::uint8_t> moving) const {
  const auto views = Viewer(scene_, t, T_world_cam).Views(visible.surfaces, Bounds(tile));
  RayBlock block;
  ForEachPart(tile, 1, [&](const Tile& part) {
    Gather(centres_, part, &block);
    const auto seen = Cull(views, block.Bounds());
    const auto place = [&](int ray) {
      return (part.y0 - tile.y0 + ray / part.width) * tile.width + part.x0 - tile.x0 + ray % part.width;
    };
    for (int i = 0; i < block.count; ++i) {
      depth[place(i)] = std::numeric_limits<float>::quiet_NaN();
      moving[place(i)] = 0;
    }
    Walk(seen, &block, [&](int i, int surface) {
      if (surface < 0) return 0.0F;
      const float z = 1.0F / block.w[i];
      if (LookUp(*seen[surface], block, i, z).coverage < 0.5F) return 1.0F;
      const int x = part.x0 + block.ray[i] % part.width;
      const int y = part.y0 + block.ray[i] / part.width;
      if (blind_[y * camera_.width() + x] != 0) return 0.0F;
      depth[place(block.ray[i])] = z;
      moving[place(block.ray[i])] = seen[surface]->moves ? 1 : 0;
      return 0.0F;
    });
  });
}

}  // namespace evo::simulation
