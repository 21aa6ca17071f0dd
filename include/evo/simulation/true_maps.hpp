#pragma once

#include "evo/core/parallel.hpp"
#include "evo/events/depth_map.hpp"
#include "evo/geometry/camera.hpp"
#include "evo/simulation/renderer.hpp"
#include "evo/simulation/scene.hpp"

namespace evo::simulation {

/// Exact depth maps of a scene in any camera, also one of another lens than the simulated one. Scene, camera and pool
/// must outlive it.
class DepthCamera {
 public:
  DepthCamera(const Scene& scene, const geometry::Camera& camera, ThreadPool* pool);

  /// Depth along the rays through the pixel centres, NaN where there is only sky, and what moves; the same for any
  /// number of threads.
  events::DepthMap At(TimeNs t, const geometry::SE3& T_world_cam) const;

 private:
  const geometry::Camera& camera_;
  Renderer renderer_;
  std::vector<Tile> tiles_;
  ThreadPool* pool_;
};

/// How far what each pixel shows moves in the image while the camera goes on by `T_next_now` (coordinates in the camera
/// now to those in the next one), everything taken as static: moving objects get the flow of a static thing in their
/// place, as in MVSEC. NaN where the depth is unknown or the point comes to lie behind the camera.
events::FlowMap StaticFlow(const geometry::Camera& camera, const events::DepthMap& depth,
                           const geometry::SE3& T_next_now);

}  // namespace evo::simulation
