#pragma once

#include <Eigen/Core>
#include <vector>

#include "evo/geometry/se3.hpp"
#include "simulation/render/projected_surface.hpp"
#include "simulation/world/scene.hpp"

namespace evo::simulation {

/// The lamps of a scene in the camera frame, without their flicker.
class Lights {
 public:
  Lights(const Lighting& lighting, const geometry::SE3& T_world_cam);

  bool any() const { return !lamps_.empty() || head_lamps_ > 0.0F; }

  /// The lights that reach the part of a surface that some rays may hit.
  struct SurfaceLights {
    struct StreetLamp {
      Eigen::Vector3f position;
      float strength = 0.0F;  ///< intensity times height over the surface
      float inverse_range2 = 0.0F;
    };
    std::vector<StreetLamp> lamps;
    float head_lamps = 0.0F;  ///< times the camera's distance from the surface's plane
  };
  SurfaceLights SelectFor(const ProjectedSurface& surface, const RayFrustum& rays) const;

 private:
  struct LampInCamera {
    Eigen::Vector3f position;
    float intensity = 0.0F;
    float range2 = 0.0F;
  };
  std::vector<LampInCamera> lamps_;
  float head_lamps_ = 0.0F;
};

/// Radiance of a white surface at depth * (x, y, 1) by the head lamps.
float HeadLampRadiance(const Lights::SurfaceLights& lights, float x, float y, float depth);
/// Radiance of a white surface at depth * (x, y, 1) by the street lamps.
float StreetLampRadiance(const Lights::SurfaceLights& lights, float x, float y, float depth);

}  // namespace evo::simulation
