#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/geometry/se3.hpp"
#include "simulation/world/scene.hpp"

namespace evo::simulation {

/// The rays (x, y, 1) of a camera with x0 <= x <= x1 and y0 <= y <= y1 on the plane z = 1.
struct RayFrustum {
  float x0 = 0.0F;
  float x1 = 0.0F;
  float y0 = 0.0F;
  float y1 = 0.0F;
};

/// Finds the surfaces of a scene that the rays of a frustum may hit during a motion: a hierarchy of axis-aligned boxes
/// (S. Rubin and T. Whitted, SIGGRAPH 1980) over the static surfaces, a bounding sphere around each moving body. It may
/// return too many surfaces but never misses one, as long as the motion between the two poses is a screw or deviates
/// from one by less than the frustum's margin.
class BoundingVolumeHierarchy {
 public:
  /// Throws Error(kInput) for a surface with a texture or body that the scene does not have.
  explicit BoundingVolumeHierarchy(const Scene& scene);

  /// Sorted indices of surfaces.
  std::vector<int> Find(const RayFrustum& rays, TimeNs from, TimeNs to, const geometry::SE3& T_world_cam_from,
                        const geometry::SE3& T_world_cam_to) const;

 private:
  struct Node {
    Eigen::Vector3d centre;
    Eigen::Vector3d half_size;
    int begin = 0;  ///< first of its surfaces in order_
    int end = 0;
    int skip = 0;  ///< the next node outside this one; its first child follows it
    bool leaf = false;
  };
  struct MovingBody {
    int body = 0;
    double radius = 0.0;
    std::vector<int> surfaces;
  };
  class SweptFrustum;

  void Build(int begin, int end);

  const Scene& scene_;
  std::vector<std::array<Eigen::Vector3d, 4>> corners_;  ///< of all surfaces, in their body's frame
  std::vector<int> order_;
  std::vector<Node> nodes_;
  std::vector<MovingBody> bodies_;
};

}  // namespace evo::simulation
