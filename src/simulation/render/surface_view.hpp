#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/geometry/se3.hpp"
#include "evo/simulation/scene.hpp"
#include "evo/simulation/surface_tree.hpp"

namespace evo::simulation {

/// c + x * dx + y * dy over the plane z = 1.
struct LinearForm {
  float c = 0.0F;
  float dx = 0.0F;
  float dy = 0.0F;

  LinearForm() = default;
  /// Coefficients of x, y and 1.
  explicit LinearForm(const Eigen::Vector3d& f)
      : c(static_cast<float>(f.z())), dx(static_cast<float>(f.x())), dy(static_cast<float>(f.y())) {}

  float At(float x, float y) const { return c + dx * x + dy * y; }
  float Min(const RayBox& r) const { return c + std::min(dx * r.x0, dx * r.x1) + std::min(dy * r.y0, dy * r.y1); }
  float Max(const RayBox& r) const { return c + std::max(dx * r.x0, dx * r.x1) + std::max(dy * r.y0, dy * r.y1); }
};

inline LinearForm operator-(const LinearForm& f, const LinearForm& g) {
  LinearForm difference;
  difference.c = f.c - g.c;
  difference.dx = f.dx - g.dx;
  difference.dy = f.dy - g.dy;
  return difference;
}

/// A surface as one camera pose sees it. With n = edge_u x edge_v and the ray (x, y, 1), the inverse depth
/// w = n.(x, y, 1) / n.origin of its plane is linear in x and y, and so are a * w, b * w and the texture coordinates
/// times w: whether a ray hits (0 <= a w, b w <= w, w > 0) needs no division.
struct SurfaceView {
  LinearForm w, aw, bw;
  LinearForm uw, vw;
  float level = 0.0F;  ///< of the texture for rays 1 apart (on z = 1) at depth 1; grows by 3/2 log2(depth)
  const Texture* texture = nullptr;
  float light = 0.0F;  ///< ambient light times shade
  float emission = 0.0F;
  bool moves = false;                                ///< belongs to a body that does
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< unit, away from the camera, in its frame
  float distance = 0.0F;                             ///< of the plane from the camera, m

  /// False where no ray of the box can hit.
  bool Meets(const RayBox& rays) const {
    return w.Max(rays) > 0.0F && aw.Max(rays) >= 0.0F && bw.Max(rays) >= 0.0F && (w - aw).Max(rays) >= 0.0F &&
           (w - bw).Max(rays) >= 0.0F;
  }
  /// True where all rays of the box hit something solid.
  bool Fills(const RayBox& rays) const;
};

/// Makes views of a scene's surfaces from one camera pose.
class Viewer {
 public:
  Viewer(const Scene& scene, TimeNs t, const geometry::SE3& T_world_cam)
      : scene_(scene), t_(t), T_cam_world_(T_world_cam.Inverse()) {}

  /// False where the surface is seen edge-on and so not at all. Texture coordinates are moved by whole pictures so that
  /// they are small, and exact in single precision, near the middle of `rays`.
  bool View(int surface, const RayBox& rays, SurfaceView* view);
  /// Those of `surfaces` that rays of the box can hit, in their order.
  std::vector<SurfaceView> Views(const std::vector<int>& surfaces, const RayBox& rays);
  /// T_cam_body of the surface's body.
  const geometry::SE3& BodyInCamera(int surface);

 private:
  const Scene& scene_;
  TimeNs t_;
  geometry::SE3 T_cam_world_;
  int body_ = -1;  ///< whose pose is at hand
  geometry::SE3 T_cam_body_;
};

}  // namespace evo::simulation
