#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/geometry/se3.hpp"
#include "simulation/render/bounding_volume_hierarchy.hpp"
#include "simulation/world/scene.hpp"

namespace evo::simulation {

/// c + x * dx + y * dy over the plane z = 1.
struct LinearForm {
  float c = 0.0F;
  float dx = 0.0F;
  float dy = 0.0F;

  LinearForm() = default;
  /// `f` holds the coefficients of x, y and 1.
  explicit LinearForm(const Eigen::Vector3d& f)
      : c(static_cast<float>(f.z())), dx(static_cast<float>(f.x())), dy(static_cast<float>(f.y())) {}

  float Evaluate(float x, float y) const { return c + dx * x + dy * y; }
  float Min(const RayFrustum& r) const { return c + std::min(dx * r.x0, dx * r.x1) + std::min(dy * r.y0, dy * r.y1); }
  float Max(const RayFrustum& r) const { return c + std::max(dx * r.x0, dx * r.x1) + std::max(dy * r.y0, dy * r.y1); }
};

inline LinearForm operator-(const LinearForm& f, const LinearForm& g) {
  LinearForm difference;
  difference.c = f.c - g.c;
  difference.dx = f.dx - g.dx;
  difference.dy = f.dy - g.dy;
  return difference;
}

/// A surface as seen from a camera pose. With n = edge_u x edge_v, the inverse depth n.(x, y, 1) / n.origin of its
/// plane along the ray (x, y, 1) is linear in x and y, and so are a, b and the texture coordinates over depth (edge
/// functions in homogeneous coordinates: M. Olano and T. Greer, Triangle Scan Conversion using 2D Homogeneous
/// Coordinates, Graphics Hardware 1997). A ray hits where 0 <= a / z, b / z <= 1 / z and 1 / z > 0, without a division.
struct ProjectedSurface {
  LinearForm inverse_depth;
  LinearForm a_over_depth, b_over_depth;
  LinearForm u_over_depth, v_over_depth;
  float mip_level = 0.0F;  ///< for rays 1 apart on the plane z = 1 at depth 1; grows by 3/2 log2(depth)
  const Texture* texture = nullptr;
  float light = 0.0F;  ///< ambient light times shade
  float emission = 0.0F;
  bool moving = false;                               ///< belongs to a moving body
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< unit, away from the camera, in the camera frame
  float distance = 0.0F;                             ///< of the plane from the camera, m

  /// False if no ray of the frustum hits.
  bool Intersects(const RayFrustum& rays) const {
    return inverse_depth.Max(rays) > 0.0F && a_over_depth.Max(rays) >= 0.0F && b_over_depth.Max(rays) >= 0.0F &&
           (inverse_depth - a_over_depth).Max(rays) >= 0.0F && (inverse_depth - b_over_depth).Max(rays) >= 0.0F;
  }
  /// True if all rays of the frustum hit and the texture has no holes.
  bool Covers(const RayFrustum& rays) const;
};

/// Projects a scene's surfaces into one camera pose.
class SurfaceProjector {
 public:
  SurfaceProjector(const Scene& scene, TimeNs t, const geometry::SE3& T_world_cam)
      : scene_(scene), t_(t), T_cam_world_(T_world_cam.Inverse()) {}

  /// False for a surface that is seen edge-on or that no ray of the frustum hits. Texture coordinates are shifted by
  /// whole periods, so that they are exact in single precision near the centre of `rays`.
  bool Project(int surface, const RayFrustum& rays, ProjectedSurface* projected);
  /// Those of `surfaces` that rays of the frustum may hit, in their order.
  std::vector<ProjectedSurface> ProjectAll(const std::vector<int>& surfaces, const RayFrustum& rays);
  /// The pose of the surface's body.
  const geometry::SE3& T_cam_body(int surface);

 private:
  const Scene& scene_;
  TimeNs t_;
  geometry::SE3 T_cam_world_;
  int body_ = -1;  ///< the body of T_cam_body_
  geometry::SE3 T_cam_body_;
};

}  // namespace evo::simulation
