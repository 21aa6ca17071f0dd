#include "simulation/render/surface_view.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

namespace evo::simulation {

using Eigen::Vector3d;

namespace {

/// The multiple of `period` below the middle of the texture coordinate f / w.
double WholePictures(const Vector3d& f, const Vector3d& w, const Vector3d& ray, int period) {
  const double inverse_depth = w.dot(ray);
  if (inverse_depth < 1e-6) return 0.0;
  return std::floor(f.dot(ray) / inverse_depth / period) * period;
}

}  // namespace

bool SurfaceView::Fills(const RayBox& rays) const {
  return texture->solid() && aw.Min(rays) >= 0.0F && bw.Min(rays) >= 0.0F && (w - aw).Min(rays) >= 0.0F &&
         (w - bw).Min(rays) >= 0.0F && w.Min(rays) > 0.0F;
}

const geometry::SE3& Viewer::BodyInCamera(int surface) {
  const int body = scene_.surfaces[surface].body;
  if (body != body_) {
    T_cam_body_ = body == 0 ? T_cam_world_ : T_cam_world_ * BodyPose(scene_, body, t_);
    body_ = body;
  }
  return T_cam_body_;
}

bool Viewer::View(int surface, const RayBox& rays, SurfaceView* view) {
  const Surface& s = scene_.surfaces[surface];
  const geometry::SE3& T_cam_body = BodyInCamera(surface);
  const Eigen::Matrix3d rotation = T_cam_body.RotationMatrix();
  const Vector3d origin = T_cam_body * s.origin;
  const Vector3d edge_u = rotation * s.edge_u;
  const Vector3d edge_v = rotation * s.edge_v;
  const Vector3d n = edge_u.cross(edge_v);
  const double k = n.dot(origin);
  const double area = n.norm();
  if (!(std::abs(k) > 1e-9 * area)) return false;

  const Vector3d w = n / k;
  const Vector3d to_a = edge_v.cross(n) / (area * area);
  const Vector3d to_b = n.cross(edge_u) / (area * area);
  const Vector3d aw = to_a - to_a.dot(origin) * w;
  const Vector3d bw = to_b - to_b.dot(origin) * w;
  view->w = LinearForm(w);
  view->aw = LinearForm(aw);
  view->bw = LinearForm(bw);
  if (!view->Meets(rays)) return false;

  const Texture& texture = scene_.textures[s.texture];
  const Vector3d middle(0.5 * (rays.x0 + rays.x1), 0.5 * (rays.y0 + rays.y1), 1.0);
  Vector3d uw = s.texel_origin.x() * w + s.texels.x() * aw;
  Vector3d vw = s.texel_origin.y() * w + s.texels.y() * bw;
  uw -= WholePictures(uw, w, middle, texture.width()) * w;
  vw -= WholePictures(vw, w, middle, texture.height()) * w;
  view->uw = LinearForm(uw);
  view->vw = LinearForm(vw);
  // The Jacobian of (u, v) by (x, y) of a projective map has the determinant det(uw, vw, w) / w^3.
  const double determinant = std::abs(uw.cross(vw).dot(w));
  view->level = determinant > 1e-30 ? QuickLog2(static_cast<float>(determinant)) * 0.5F : -50.0F;
  view->texture = &texture;
  view->light = static_cast<float>(scene_.lighting.ambient) * s.shade;
  view->emission = s.emission;
  view->moves = s.body != 0;
  view->normal = (n / (k > 0.0 ? area : -area)).cast<float>();
  view->distance = static_cast<float>(std::abs(k) / area);
  return true;
}

std::vector<SurfaceView> Viewer::Views(const std::vector<int>& surfaces, const RayBox& rays) {
  std::vector<SurfaceView> views;
  views.reserve(surfaces.size());
  SurfaceView view;
  for (const int surface : surfaces) {
    if (View(surface, rays, &view)) views.push_back(view);
  }
  return views;
}

}  // namespace evo::simulation
