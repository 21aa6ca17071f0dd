#pragma once

#include <memory>

#include "evo/core/time.hpp"
#include "evo/events/depth_map.hpp"
#include "evo/geometry/camera.hpp"
#include "evo/geometry/se3.hpp"

namespace evo {
class ThreadPool;
}

namespace evo::simulation {

class Renderer;
struct Scene;

/// Renders exact depth maps of a scene for any camera, also for one of another lens than the simulated one. Scene,
/// camera and pool must outlive it.
class DepthCamera {
 public:
  DepthCamera(const Scene& scene, const geometry::Camera& camera, ThreadPool* pool);
  ~DepthCamera();

  /// Depth (z in the camera frame, m) along the rays through the pixel centres, NaN for sky; and the pixels that show a
  /// moving body. The result does not depend on the number of threads.
  events::DepthMap Render(TimeNs t, const geometry::SE3& T_world_cam) const;

 private:
  const geometry::Camera& camera_;
  std::unique_ptr<const Renderer> renderer_;
  ThreadPool* pool_;
};

/// Optical flow (px) of each pixel while the camera moves by `T_next_now`. All points count as static: a moving body
/// gets the flow of a static one in its place, as in MVSEC. NaN for an unknown depth and for a point that comes to lie
/// behind the camera.
events::FlowMap StaticFlow(const geometry::Camera& camera, const events::DepthMap& depth,
                           const geometry::SE3& T_next_now);

}  // namespace evo::simulation
