#include "simulation/render/lights.hpp"

#include <algorithm>
#include <cmath>

namespace evo::simulation {

namespace {

constexpr double kMinRadiance = 5e-4;  // a lamp fades out below it: a quarter of the sensor's dark current
constexpr float kBeamX = 0.35F;        // half widths of the head lamps' beam on the plane z = 1: a dipped beam
constexpr float kBeamY = 0.15F;
constexpr float kMinInverseDepth = 1e-4F;  // 1/m: 10 km away, no lamp reaches there

float Square(float x) { return x * x; }

/// Squared distance of x from [low, high].
float SquaredGap(float x, float low, float high) { return Square(std::max({low - x, x - high, 0.0F})); }

}  // namespace

Lights::Lights(const Lighting& lighting, const geometry::SE3& T_world_cam)
    : head_lamps_(static_cast<float>(lighting.head_lamps)) {
  const geometry::SE3 T_cam_world = T_world_cam.Inverse();
  for (const Lamp& lamp : lighting.lamps) {
    lamps_.push_back({(T_cam_world * lamp.position).cast<float>(), static_cast<float>(lamp.intensity),
                      static_cast<float>(lamp.intensity / kMinRadiance)});
  }
}

Lights::SurfaceLights Lights::SelectFor(const ProjectedSurface& surface, const RayFrustum& rays) const {
  SurfaceLights selected;
  selected.head_lamps = head_lamps_ * surface.distance;
  const float near = 1.0F / std::max(surface.inverse_depth.Max(rays), kMinInverseDepth);
  const float far = 1.0F / std::max(surface.inverse_depth.Min(rays), kMinInverseDepth);
  for (const LampInCamera& lamp : lamps_) {
    const float height = surface.distance - surface.normal.dot(lamp.position);  // on the visible side
    if (height <= 0.0F || Square(height) >= lamp.range2) continue;
    const float gap2 = SquaredGap(lamp.position.x(), std::min(near * rays.x0, far * rays.x0),
                                  std::max(near * rays.x1, far * rays.x1)) +
                       SquaredGap(lamp.position.y(), std::min(near * rays.y0, far * rays.y0),
                                  std::max(near * rays.y1, far * rays.y1)) +
                       SquaredGap(lamp.position.z(), near, far);
    if (gap2 < lamp.range2) selected.lamps.push_back({lamp.position, lamp.intensity * height, 1.0F / lamp.range2});
  }
  return selected;
}

float HeadLampRadiance(const Lights::SurfaceLights& lights, float x, float y, float depth) {
  const float beam = Square(1.0F / (1.0F + Square(x / kBeamX) + Square(y / kBeamY)));
  const float distance2 = Square(depth) * (1.0F + Square(x) + Square(y));
  return lights.head_lamps * beam / (distance2 * std::sqrt(distance2));
}

float StreetLampRadiance(const Lights::SurfaceLights& lights, float x, float y, float depth) {
  float light = 0.0F;
  for (const auto& lamp : lights.lamps) {
    const float distance2 = Square(depth * x - lamp.position.x()) + Square(depth * y - lamp.position.y()) +
                            Square(depth - lamp.position.z());
    const float fade = std::max(0.0F, 1.0F - Square(distance2 * lamp.inverse_range2));
    light += lamp.strength * Square(fade) / (distance2 * std::sqrt(distance2));
  }
  return light;
}

}  // namespace evo::simulation
