#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/geometry/se3.hpp"
#include "evo/simulation/scene.hpp"

namespace evo::simulation {

/// A bundle of rays (x, y, 1) with x, y between the bounds, on the plane z = 1 of a camera.
struct RayBox {
  float x0 = 0.0F;
  float x1 = 0.0F;
  float y0 = 0.0F;
  float y1 = 0.0F;
};

/// Finds the surfaces of a scene that a bundle of rays may hit during a motion: a tree of axis-aligned boxes over what
/// stands still, a ball around each thing that moves. It may name a surface too many, never one too few, as long as the
/// motion between the two poses is a screw, or so smooth that it strays from one by less than the bundle is widened.
class SurfaceTree {
 public:
  explicit SurfaceTree(const Scene& scene);

  /// Sorted indices.
  std::vector<int> Find(const RayBox& rays, TimeNs from, TimeNs to, const geometry::SE3& T_world_cam_from,
                        const geometry::SE3& T_world_cam_to) const;

 private:
  struct Node {
    Eigen::Vector3d centre;
    Eigen::Vector3d half;
    int begin = 0;  ///< its surfaces, in order_
    int end = 0;
    int skip = 0;  ///< the next node if this one is passed over; its first child follows it
    bool leaf = false;
  };
  struct MovingBody {
    int body = 0;
    double radius = 0.0;
    std::vector<int> surfaces;
  };
  class Sweep;

  void Build(int begin, int end);

  const Scene& scene_;
  std::vector<std::array<Eigen::Vector3d, 4>> corners_;  ///< of all surfaces, in their body's frame
  std::vector<int> order_;
  std::vector<Node> nodes_;
  std::vector<MovingBody> bodies_;
};

/// T_world_body of `body` at `t`: the identity for body 0.
geometry::SE3 BodyPose(const Scene& scene, int body, TimeNs t);

}  // namespace evo::simulation
