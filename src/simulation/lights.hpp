#pragma once

#include <Eigen/Core>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/geometry/se3.hpp"
#include "evo/simulation/scene.hpp"
#include "simulation/surface_view.hpp"

namespace evo {

/// The lamps of a scene at one time, in the camera's frame.
class Lights {
 public:
  Lights(const Lighting& lighting, TimeNs t, const SE3& T_world_cam);

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

/// Radiance of a white surface at depth * (x, y, 1) by the lamps alone.
float LampLight(const Lights::OnSurface& lights, float x, float y, float depth);

}  // namespace evo
