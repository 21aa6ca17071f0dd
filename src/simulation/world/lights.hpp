#pragma once

#include <Eigen/Core>
#include <vector>

#include "evo/geometry/se3.hpp"
#include "evo/simulation/scene.hpp"
#include "simulation/render/surface_view.hpp"

namespace evo::simulation {

/// The lamps of a scene in the camera's frame, without their flicker.
class Lights {
 public:
  Lights(const Lighting& lighting, const geometry::SE3& T_world_cam);

  bool any() const { return !lamps_.empty() || head_lamps_ > 0.0F; }

  /// What shines on the part of a surface that some rays may hit.
  struct OnSurface {
    struct Shine {
      Eigen::Vector3f position;
      float strength = 0.0F;  ///< intensity times height over the surface
      float inverse_range2 = 0.0F;
    };
    std::vector<Shine> lamps;
    float head_lamps = 0.0F;  ///< times the camera's distance from the surface's plane
  };
  OnSurface For(const SurfaceView& view, const RayBox& rays) const;

 private:
  struct LampInCamera {
    Eigen::Vector3f position;
    float intensity = 0.0F;
    float range2 = 0.0F;
  };
  std::vector<LampInCamera> lamps_;
  float head_lamps_ = 0.0F;
};

/// Radiance of a white surface at depth * (x, y, 1) by the head lamps alone.
float HeadLampLight(const Lights::OnSurface& lights, float x, float y, float depth);
/// And by the street lamps alone.
float StreetLampLight(const Lights::OnSurface& lights, float x, float y, float depth);

}  // namespace evo::simulation
