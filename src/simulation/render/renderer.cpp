#include "simulation/render/renderer.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "evo/core/error.hpp"
#include "simulation/fast_math.hpp"
#include "simulation/render/bonnet_mirror.hpp"
#include "simulation/render/lights.hpp"
#include "simulation/render/projected_surface.hpp"
#include "simulation/render/ray_packet.hpp"

namespace evo::simulation {

using Eigen::Vector2d;

namespace {

constexpr int kMaxSamples = 16;  // a pixel's rays must fit into one packet

/// Shift of a pixel's rays within the columns (or rows) of their grid, in [0, 1), by the pixel's coordinates along and
/// across an edge between columns (or rows): van der Corput's sequence along the edge, which no slope of it follows.
double GridShift(int along, int across) {
  constexpr double kGolden = 0.6180339887498949;
  double shift = kGolden * across;
  for (double digit = 0.5; along > 0; along /= 2, digit /= 2.0) shift += digit * (along % 2);
  return shift - std::floor(shift);
}

/// Cuts a tile into parts whose rays fit into a packet each.
template <typename Use>
void ForEachPart(const Tile& tile, int rays_per_pixel, const Use& use) {
  const int side = static_cast<int>(std::sqrt(RayPacket::kSize / rays_per_pixel));
  for (int y = 0; y < tile.height; y += side) {
    for (int x = 0; x < tile.width; x += side) {
      use(Tile{tile.x0 + x, tile.y0 + y, std::min(side, tile.width - x), std::min(side, tile.height - y)});
    }
  }
}

float MipLevel(const ProjectedSurface& surface, const RayPacket& packet, int i, float depth) {
  return surface.mip_level + 1.5F * FastLog2(depth) + packet.log2_spacing[i];
}

Texture::Sample LookUpTexture(const ProjectedSurface& surface, const RayPacket& packet, int i, float depth) {
  return surface.texture->LookupAtLevel(surface.u_over_depth.Evaluate(packet.x[i], packet.y[i]) * depth,
                                        surface.v_over_depth.Evaluate(packet.x[i], packet.y[i]) * depth,
                                        MipLevel(surface, packet, i, depth));
}

/// Radiance along each ray of a packet, in the parts of Renderer::Radiance.
struct PacketRadiance {
  std::array<float, RayPacket::kSize> steady;
  std::array<float, RayPacket::kSize> lamps;
  bool has_lamps = false;  ///< `lamps` is not all 0
};

void ShadeRays(const std::vector<ProjectedSurface>& surfaces, const Lights& lights, float sky, RayPacket* packet,
               PacketRadiance* radiance) {
  const RayFrustum rays = packet->Frustum();
  const auto candidates = CullOccluded(surfaces, rays);
  std::vector<Lights::SurfaceLights> surface_lights;
  radiance->has_lamps = false;
  for (const ProjectedSurface* surface : candidates) {
    if (!lights.any()) break;
    surface_lights.push_back(lights.SelectFor(*surface, rays));
    radiance->has_lamps = radiance->has_lamps || !surface_lights.back().lamps.empty();
  }
  std::fill_n(radiance->steady.begin(), packet->count, 0.0F);
  std::fill_n(radiance->lamps.begin(), packet->count, 0.0F);
  TraceThroughHoles(candidates, packet, [&](int i, int index) {
    const int ray = packet->ray[i];
    if (index < 0) {
      radiance->steady[ray] += packet->transmittance[i] * sky;
      return 0.0F;
    }
    const ProjectedSurface& surface = *candidates[index];
    const float depth = 1.0F / packet->inverse_depth[i];
    const Texture::Sample sample = LookUpTexture(surface, *packet, i, depth);
    const float reflected = packet->transmittance[i] * sample.reflected;
    float light = surface.light;
    if (!surface_lights.empty()) light += HeadLampRadiance(surface_lights[index], packet->x[i], packet->y[i], depth);
    if (radiance->has_lamps) {
      radiance->lamps[ray] += reflected * StreetLampRadiance(surface_lights[index], packet->x[i], packet->y[i], depth);
    }
    radiance->steady[ray] += reflected * light + packet->transmittance[i] * sample.coverage * surface.emission;
    return 1.0F - sample.coverage;
  });
}

}  // namespace

Renderer::Renderer(const Scene& scene, const geometry::Camera& camera, int samples)
    : scene_(scene),
      camera_(camera),
      hierarchy_(scene),
      has_no_ray_(static_cast<std::size_t>(camera.width()) * static_cast<std::size_t>(camera.height())) {
  if (samples < 1 || samples > kMaxSamples) {
    throw Error(ErrorKind::kInput, fmt::format("renderer: samples must lie in [1, {}], not {}", kMaxSamples, samples));
  }
  centres_ = CastRays(1);
  samples_ = samples == 1 ? centres_ : CastRays(samples);
  max_spacing_ = std::exp2(*std::max_element(centres_.log2_spacing.begin(), centres_.log2_spacing.end()));
}

Renderer::Rays Renderer::CastRays(int samples) {
  Rays rays;
  rays.per_pixel = samples * samples;
  Vector2d ray = Vector2d::Zero();  // the last one stands in for one that does not exist
  for (int p = 0; p < camera_.width() * camera_.height(); ++p) {
    const Vector2d centre(p % camera_.width(), p / camera_.width());
    const double shift_x = samples == 1 ? 0.5 : GridShift(p / camera_.width(), p % camera_.width());
    const double shift_y = samples == 1 ? 0.5 : GridShift(p % camera_.width(), p / camera_.width());
    for (int j = 0; j < samples; ++j) {
      for (int i = 0; i < samples; ++i) {
        const Vector2d offset((i + (j + shift_x) / samples) / samples,
                              (j + (samples - 1 - i + shift_y) / samples) / samples);
        const auto found = camera_.Undistort(centre + offset - Vector2d(0.5, 0.5));
        if (found) ray = *found;
        if (!found) has_no_ray_[p] = 1;
        AddRay(ray, &rays);
      }
    }
    // A pixel's area on the plane z = 1 is 1 / det of the lens model's Jacobian, by forward differences.
    constexpr double kStep = 1e-4;
    Eigen::Matrix2d jacobian;
    for (int c = 0; c < 2; ++c) {
      jacobian.col(c) = (camera_.Distort(ray + kStep * Vector2d::Unit(c)) - camera_.Distort(ray)) / kStep;
    }
    const double pixels2 = std::max(std::abs(jacobian.determinant()), 1.0);
    rays.log2_spacing.push_back(static_cast<float>(-0.5 * std::log2(pixels2) - std::log2(samples)));
  }
  return rays;
}

/// Adds a ray, or its mirror image where it meets the bonnet.
void Renderer::AddRay(const Vector2d& ray, Rays* rays) const {
  Vector2d seen = ray;
  if (scene_.bonnet) {
    const auto reflection = BonnetMirror(*scene_.bonnet).Reflect(ray);
    if (reflection) seen = reflection->ray;
    rays->reflectivity.push_back(reflection ? static_cast<float>(reflection->reflectivity) : 0.0F);
  }
  rays->x.push_back(static_cast<float>(seen.x()));
  rays->y.push_back(static_cast<float>(seen.y()));
}

Renderer::VisibleSet Renderer::FindVisible(const Tile& tile, TimeNs from, TimeNs to,
                                           const geometry::SE3& T_world_cam_from,
                                           const geometry::SE3& T_world_cam_to) const {
  RayFrustum rays = TileFrustum(tile);
  rays = {rays.x0 - max_spacing_, rays.x1 + max_spacing_, rays.y0 - max_spacing_, rays.y1 + max_spacing_};
  return {hierarchy_.Find(rays, from, to, T_world_cam_from, T_world_cam_to)};
}

RayFrustum Renderer::TileFrustum(const Tile& tile) const {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  RayFrustum bounds{kFar, -kFar, kFar, -kFar};
  for (int y = tile.y0; y < tile.y0 + tile.height; ++y) {
    const int first = (y * camera_.width() + tile.x0) * samples_.per_pixel;
    for (int i = first; i < first + tile.width * samples_.per_pixel; ++i) {
      bounds.x0 = std::min(bounds.x0, samples_.x[i]);
      bounds.x1 = std::max(bounds.x1, samples_.x[i]);
      bounds.y0 = std::min(bounds.y0, samples_.y[i]);
      bounds.y1 = std::max(bounds.y1, samples_.y[i]);
    }
  }
  return bounds;
}

void Renderer::GatherRays(const Rays& rays, const Tile& part, RayPacket* packet) const {
  int n = 0;
  for (int y = part.y0; y < part.y0 + part.height; ++y) {
    for (int x = part.x0; x < part.x0 + part.width; ++x) {
      const int pixel = y * camera_.width() + x;
      for (int k = 0; k < rays.per_pixel; ++k, ++n) {
        packet->x[n] = rays.x[pixel * rays.per_pixel + k];
        packet->y[n] = rays.y[pixel * rays.per_pixel + k];
        packet->log2_spacing[n] = rays.log2_spacing[pixel];
        packet->ray[n] = n;
      }
    }
  }
  packet->count = n;
  std::fill_n(packet->max_inverse_depth.begin(), n, std::numeric_limits<float>::infinity());
  std::fill_n(packet->transmittance.begin(), n, 1.0F);
}

float Renderer::PixelRadiance(int pixel, const float* radiance, float bonnet_radiance) const {
  const int count = samples_.per_pixel;
  float sum = 0.0F;
  for (int k = 0; k < count; ++k) {
    const float reflectivity = samples_.reflectivity.empty() ? 0.0F : samples_.reflectivity[pixel * count + k];
    sum += reflectivity > 0.0F ? reflectivity * radiance[k] + bonnet_radiance : radiance[k];
  }
  return sum / static_cast<float>(count);
}

void Renderer::Render(const Tile& tile, const VisibleSet& visible, TimeNs t, const geometry::SE3& T_world_cam,
                      Radiance* radiance) const {
  const auto surfaces = SurfaceProjector(scene_, t, T_world_cam).ProjectAll(visible.surfaces, TileFrustum(tile));
  const Lights lights(scene_.lighting, T_world_cam);
  const int n = samples_.per_pixel;
  const float bonnet = scene_.bonnet ? static_cast<float>(scene_.bonnet->radiance) : 0.0F;
  radiance->steady.assign(tile.pixels(), 0.0F);
  radiance->lamps.assign(tile.pixels(), 0.0F);
  radiance->has_lamps = false;
  RayPacket packet;
  PacketRadiance packet_radiance;
  ForEachPart(tile, n, [&](const Tile& part) {
    GatherRays(samples_, part, &packet);
    ShadeRays(surfaces, lights, static_cast<float>(scene_.lighting.sky), &packet, &packet_radiance);
    radiance->has_lamps = radiance->has_lamps || packet_radiance.has_lamps;
    for (int p = 0; p < part.width * part.height; ++p) {
      const int x = part.x0 + p % part.width;
      const int y = part.y0 + p / part.width;
      const int pixel = y * camera_.width() + x;
      if (has_no_ray_[pixel] != 0) continue;
      const int position = (y - tile.y0) * tile.width + x - tile.x0;
      radiance->steady[position] = PixelRadiance(pixel, &packet_radiance.steady[p * n], bonnet);
      if (packet_radiance.has_lamps) {
        radiance->lamps[position] = PixelRadiance(pixel, &packet_radiance.lamps[p * n], 0.0F);
      }
    }
  });
}

void Renderer::RenderDepth(const Tile& tile, const VisibleSet& visible, TimeNs t, const geometry::SE3& T_world_cam,
                           std::span<float> depth, std::span<std::uint8_t> moving) const {
  const auto surfaces = SurfaceProjector(scene_, t, T_world_cam).ProjectAll(visible.surfaces, TileFrustum(tile));
  RayPacket packet;
  ForEachPart(tile, 1, [&](const Tile& part) {
    GatherRays(centres_, part, &packet);
    const auto candidates = CullOccluded(surfaces, packet.Frustum());
    const auto position = [&](int ray) {
      return (part.y0 - tile.y0 + ray / part.width) * tile.width + part.x0 - tile.x0 + ray % part.width;
    };
    for (int i = 0; i < packet.count; ++i) {
      depth[position(i)] = std::numeric_limits<float>::quiet_NaN();
      moving[position(i)] = 0;
    }
    TraceThroughHoles(candidates, &packet, [&](int i, int index) {
      if (index < 0) return 0.0F;
      const float z = 1.0F / packet.inverse_depth[i];
      if (LookUpTexture(*candidates[index], packet, i, z).coverage < 0.5F) return 1.0F;
      const int x = part.x0 + packet.ray[i] % part.width;
      const int y = part.y0 + packet.ray[i] / part.width;
      const int pixel = y * camera_.width() + x;
      if (has_no_ray_[pixel] != 0 || (scene_.bonnet && centres_.reflectivity[pixel] > 0.0F)) return 0.0F;
      depth[position(packet.ray[i])] = z;
      moving[position(packet.ray[i])] = candidates[index]->moving ? 1 : 0;
      return 0.0F;
    });
  });
}

}  // namespace evo::simulation
