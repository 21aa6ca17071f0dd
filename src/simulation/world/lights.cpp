#include "simulation/world/lights.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace evo::simulation {

namespace {

constexpr double kFaintest = 5e-4;  // radiance below which a lamp fades out
constexpr float kBeamX = 0.35F;     // half-widths of the head lamps' beam on the plane z = 1
constexpr float kBeamY = 0.15F;

float Square(float x) { return x * x; }

/// Squared distance of a point from an interval.
float Gap2(float x, float low, float high) { return Square(std::max({low - x, x - high, 0.0F})); }

}  // namespace

double Flicker(const Lighting& lighting, TimeNs t) {
  return 1.0 + lighting.flicker_depth * std::sin(2.0 * std::numbers::pi * lighting.flicker_hz * ToSeconds(t));
}

Lights::Lights(const Lighting& lighting, const geometry::SE3& T_world_cam)
    : head_lamps_(static_cast<float>(lighting.head_lamps)) {
  const geometry::SE3 T_cam_world = T_world_cam.Inverse();
  for (const Lamp& lamp : lighting.lamps) {
    lamps_.push_back({(T_cam_world * lamp.position).cast<float>(), static_cast<float>(lamp.intensity),
                      static_cast<float>(lamp.intensity / kFaintest)});
  }
}

Lights::OnSurface Lights::For(const SurfaceView& view, const RayBox& rays) const {
  OnSurface shining;
  shining.head_lamps = head_lamps_ * view.distance;
  const float near = 1.0F / std::max(view.w.Max(rays), 1e-4F);
  const float far = 1.0F / std::max(view.w.Min(rays), 1e-4F);
  for (const LampInCamera& lamp : lamps_) {
    const float height = view.distance - view.normal.dot(lamp.position);  // on the side that the camera sees
    if (height <= 0.0F || Square(height) >= lamp.range2) continue;
    const float gap2 =
        Gap2(lamp.position.x(), std::min(near * rays.x0, far * rays.x0), std::max(near * rays.x1, far * rays.x1)) +
        Gap2(lamp.position.y(), std::min(near * rays.y0, far * rays.y0), std::max(near * rays.y1, far * rays.y1)) +
        Gap2(lamp.position.z(), near, far);
    if (gap2 < lamp.range2) shining.lamps.push_back({lamp.position, lamp.intensity * height, 1.0F / lamp.range2});
  }
  return shining;
}

float HeadLampLight(const Lights::OnSurface& lights, float x, float y, float depth) {
  const float beam = Square(1.0F / (1.0F + Square(x / kBeamX) + Square(y / kBeamY)));
  const float distance2 = Square(depth) * (1.0F + Square(x) + Square(y));
  return lights.head_lamps * beam / (distance2 * std::sqrt(distance2));
}

float StreetLampLight(const Lights::OnSurface& lights, float x, float y, float depth) {
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
