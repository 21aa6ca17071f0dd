#include "simulation/render/projected_surface.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "simulation/fast_math.hpp"

namespace evo::simulation {

using Eigen::Vector3d;

namespace {

constexpr double kMinInverseDepth = 1e-6;  // 1/m: 1000 km away; beyond it, a texture coordinate has no precision left
constexpr double kEdgeOn = 1e-9;           // m: the camera is this near to the surface's plane
constexpr double kMinDeterminant = 1e-30;  // FastLog2 needs a normal float
constexpr float kFinestLevel = -50.0F;     // below the finest mip level, whatever is added

/// The largest multiple of `period` below the texture coordinate along `ray`.
double WrapOffset(const Vector3d& u_over_depth, const Vector3d& inverse_depth, const Vector3d& ray, int period) {
  const double at_ray = inverse_depth.dot(ray);
  if (at_ray < kMinInverseDepth) return 0.0;
  return std::floor(u_over_depth.dot(ray) / at_ray / period) * period;
}

}  // namespace

bool ProjectedSurface::Covers(const RayFrustum& rays) const {
  return texture->solid() && a_over_depth.Min(rays) >= 0.0F && b_over_depth.Min(rays) >= 0.0F &&
         (inverse_depth - a_over_depth).Min(rays) >= 0.0F && (inverse_depth - b_over_depth).Min(rays) >= 0.0F &&
         inverse_depth.Min(rays) > 0.0F;
}

const geometry::SE3& SurfaceProjector::T_cam_body(int surface) {
  const int body = scene_.surfaces[surface].body;
  if (body != body_) {
    T_cam_body_ = body == 0 ? T_cam_world_ : T_cam_world_ * BodyPose(scene_, body, t_);
    body_ = body;
  }
  return T_cam_body_;
}

bool SurfaceProjector::Project(int surface, const RayFrustum& rays, ProjectedSurface* projected) {
  const Surface& s = scene_.surfaces[surface];
  const geometry::SE3& pose = T_cam_body(surface);
  const Eigen::Matrix3d R_cam_body = pose.RotationMatrix();
  const Vector3d origin = pose * s.origin;
  const Vector3d edge_u = R_cam_body * s.edge_u;
  const Vector3d edge_v = R_cam_body * s.edge_v;
  const Vector3d n = edge_u.cross(edge_v);
  const double k = n.dot(origin);
  const double area = n.norm();
  if (!(std::abs(k) > kEdgeOn * area)) return false;

  // Coefficients of the inverse depth w and of a, b, u and v times w.
  const Vector3d w = n / k;
  const Vector3d to_a = edge_v.cross(n) / (area * area);
  const Vector3d to_b = n.cross(edge_u) / (area * area);
  const Vector3d aw = to_a - to_a.dot(origin) * w;
  const Vector3d bw = to_b - to_b.dot(origin) * w;
  projected->inverse_depth = LinearForm(w);
  projected->a_over_depth = LinearForm(aw);
  projected->b_over_depth = LinearForm(bw);
  if (!projected->Intersects(rays)) return false;

  const Texture& texture = scene_.textures[s.texture];
  const Vector3d centre(0.5 * (rays.x0 + rays.x1), 0.5 * (rays.y0 + rays.y1), 1.0);
  Vector3d uw = s.texel_origin.x() * w + s.texels.x() * aw;
  Vector3d vw = s.texel_origin.y() * w + s.texels.y() * bw;
  uw -= WrapOffset(uw, w, centre, texture.width()) * w;
  vw -= WrapOffset(vw, w, centre, texture.height()) * w;
  projected->u_over_depth = LinearForm(uw);
  projected->v_over_depth = LinearForm(vw);
  // The Jacobian of (u, v) with respect to (x, y) has the determinant det(uw, vw, w) / w^3.
  const double determinant = std::abs(uw.cross(vw).dot(w));
  projected->mip_level =
      determinant > kMinDeterminant ? FastLog2(static_cast<float>(determinant)) * 0.5F : kFinestLevel;
  projected->texture = &texture;
  projected->light = static_cast<float>(scene_.lighting.ambient) * s.shade;
  projected->emission = s.emission;
  projected->moving = s.body != 0;
  projected->normal = (n / (k > 0.0 ? area : -area)).cast<float>();
  projected->distance = static_cast<float>(std::abs(k) / area);
  return true;
}

std::vector<ProjectedSurface> SurfaceProjector::ProjectAll(const std::vector<int>& surfaces, const RayFrustum& rays) {
  std::vector<ProjectedSurface> projected;
  projected.reserve(surfaces.size());
  ProjectedSurface current;
  for (const int surface : surfaces) {
    if (Project(surface, rays, &current)) projected.push_back(current);
  }
  return projected;
}

}  // namespace evo::simulation
