#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "simulation/render/projected_surface.hpp"
#include "simulation/render/renderer.hpp"

namespace evo::simulation {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr double kMarginPx = 2.0;  // of the tile: a pixel's rays and the deviation from a screw reach beyond its centre

struct Range {
  double low = 0.0;
  double high = 0.0;
};

/// Inverse depths (1/m) of the surface along rays of the frustum.
Range InverseDepths(const Surface& s, const ProjectedSurface& projected, const geometry::SE3& T_cam_body,
                    const RayFrustum& rays) {
  double near = std::numeric_limits<double>::infinity();
  double far = 0.0;
  for (const Vector3d& corner : {s.origin, Vector3d(s.origin + s.edge_u), Vector3d(s.origin + s.edge_v),
                                 Vector3d(s.origin + s.edge_u + s.edge_v)}) {
    const double z = (T_cam_body * corner).z();
    near = std::min(near, z);
    far = std::max(far, z);
  }
  Range range{std::max(0.0, static_cast<double>(projected.inverse_depth.Min(rays))), projected.inverse_depth.Max(rays)};
  if (far > 0.0) range.low = std::max(range.low, 1.0 / far);
  if (near > 0.0) range.high = std::min(range.high, 1.0 / near);
  return range;
}

/// Displacement on the plane z = 1 of the point at an inverse depth along `ray` by a rigid motion.
Vector2d Displacement(const Vector2d& ray, double inverse_depth, const Eigen::Matrix3d& rotation,
                      const Vector3d& translation) {
  constexpr double kMinDepthRatio = 0.1;  // of the new to the old depth: a point that passes the camera has no image
  const Vector3d moved = rotation * ray.homogeneous() + inverse_depth * translation;
  return moved.head<2>() / std::max(moved.z(), kMinDepthRatio) - ray;
}

RayFrustum Widened(const RayFrustum& rays, double margin) {
  const auto m = static_cast<float>(margin);
  return {rays.x0 - m, rays.x1 + m, rays.y0 - m, rays.y1 + m};
}

}  // namespace

Vector2d Renderer::CentreRay(int x, int y) const {
  const int pixel = y * camera_.width() + x;
  return {centres_.x[pixel], centres_.y[pixel]};
}

Eigen::Matrix2d Renderer::J_pixel_normalized(int x, int y) const {
  constexpr double kStep = 1e-3;  // central differences; about a third of a pixel
  // That of the lens, also where the bonnet, which is convex, mirrors the ray.
  const Vector2d ray = scene_.bonnet ? camera_.Undistort({x, y}).value_or(CentreRay(x, y)) : CentreRay(x, y);
  Eigen::Matrix2d jacobian;
  for (int c = 0; c < 2; ++c) {
    const Vector2d step = kStep * Vector2d::Unit(c);
    jacobian.col(c) = (camera_.Distort(ray + step) - camera_.Distort(ray - step)) / (2.0 * kStep);
  }
  return jacobian;
}

double Renderer::ImageSpeed(const Tile& tile, const VisibleSet& visible, TimeNs from, TimeNs to,
                            const geometry::SE3& T_world_cam_from, const geometry::SE3& T_world_cam_to) const {
  if (to <= from) return 0.0;
  // Motion is evaluated at the tile's corners and centre.
  const int right = tile.x0 + tile.width - 1;
  const int bottom = tile.y0 + tile.height - 1;
  const std::array<std::array<int, 2>, 5> pixels{{{tile.x0, tile.y0},
                                                  {right, tile.y0},
                                                  {tile.x0, bottom},
                                                  {right, bottom},
                                                  {(tile.x0 + right) / 2, (tile.y0 + bottom) / 2}}};
  std::array<Vector2d, 5> rays;
  std::array<Eigen::Matrix2d, 5> jacobians;
  double min_focal_px = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    rays[i] = CentreRay(pixels[i][0], pixels[i][1]);
    jacobians[i] = J_pixel_normalized(pixels[i][0], pixels[i][1]);
    min_focal_px = std::min(min_focal_px, jacobians[i].colwise().norm().minCoeff());
  }
  const auto max_displacement_px = [&](const Range& inverse_depths, const geometry::SE3& T_to_from) {
    const Eigen::Matrix3d rotation = T_to_from.RotationMatrix();
    double max = 0.0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      for (const double w : {inverse_depths.low, inverse_depths.high}) {
        max = std::max(max, (jacobians[i] * Displacement(rays[i], w, rotation, T_to_from.translation())).norm());
      }
    }
    return max;
  };

  const RayFrustum frustum = TileFrustum(tile);
  const geometry::SE3 T_to_from = T_world_cam_to.Inverse() * T_world_cam_from;
  double max_px = max_displacement_px({0.0, 0.0}, T_to_from);  // the sky
  SurfaceProjector before(scene_, from, T_world_cam_from);
  SurfaceProjector after(scene_, to, T_world_cam_to);
  for (const int index : visible.surfaces) {
    const geometry::SE3 T_to_from_body = after.T_cam_body(index) * before.T_cam_body(index).Inverse();
    for (const bool forward : {true, false}) {
      // A point that the tile shows at some time is at most half of its displacement outside the tile at one end.
      SurfaceProjector& projector = forward ? before : after;
      const geometry::SE3 T_end_begin = forward ? T_to_from_body : T_to_from_body.Inverse();
      ProjectedSurface projected;
      RayFrustum widened = Widened(frustum, kMarginPx / min_focal_px);
      for (int pass = 0; pass < 2; ++pass) {
        if (!projector.Project(index, widened, &projected)) break;
        const Range range = InverseDepths(scene_.surfaces[index], projected, projector.T_cam_body(index), widened);
        const double displacement = max_displacement_px(range, T_end_begin);
        if (pass == 1) max_px = std::max(max_px, displacement);
        widened = Widened(frustum, (0.5 * displacement + kMarginPx) / min_focal_px);
      }
    }
  }
  return max_px / ToSeconds(to - from);
}

}  // namespace evo::simulation
