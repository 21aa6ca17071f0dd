#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "evo/simulation/renderer.hpp"
#include "simulation/render/surface_view.hpp"

namespace evo::simulation {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

struct Range {
  double low = 0.0;
  double high = 0.0;
};

/// Inverse depths that rays of the box may find on the surface.
Range InverseDepths(const Surface& s, const SurfaceView& view, const geometry::SE3& T_cam_body, const RayBox& rays) {
  double near = std::numeric_limits<double>::infinity();
  double far = 0.0;
  for (const Vector3d& corner : {s.origin, Vector3d(s.origin + s.edge_u), Vector3d(s.origin + s.edge_v),
                                 Vector3d(s.origin + s.edge_u + s.edge_v)}) {
    const double z = (T_cam_body * corner).z();
    near = std::min(near, z);
    far = std::max(far, z);
  }
  Range range{std::max(0.0, static_cast<double>(view.w.Min(rays))), view.w.Max(rays)};
  if (far > 0.0) range.low = std::max(range.low, 1.0 / far);
  if (near > 0.0) range.high = std::min(range.high, 1.0 / near);
  return range;
}

/// Where the point seen along `ray` (on the plane z = 1) at an inverse depth is seen after `motion`, less the ray.
Vector2d Shift(const Vector2d& ray, double inverse_depth, const Eigen::Matrix3d& rotation,
               const Vector3d& translation) {
  constexpr double kNearest = 0.1;  // of the former depth: it goes past the camera
  const Vector3d moved = rotation * ray.homogeneous() + inverse_depth * translation;
  return moved.head<2>() / std::max(moved.z(), kNearest) - ray;
}

RayBox Widened(const RayBox& box, double by) {
  const auto w = static_cast<float>(by);
  return {box.x0 - w, box.x1 + w, box.y0 - w, box.y1 + w};
}

}  // namespace

Vector2d Renderer::Centre(int x, int y) const {
  const int pixel = y * camera_.width() + x;
  return {centres_.x[pixel], centres_.y[pixel]};
}

Eigen::Matrix2d Renderer::PixelsPerStep(int x, int y) const {
  constexpr double kStep = 1e-3;
  const Vector2d ray = Centre(x, y);
  Eigen::Matrix2d pixels;
  for (int c = 0; c < 2; ++c) {
    const Vector2d step = kStep * Vector2d::Unit(c);
    pixels.col(c) = (camera_.Distort(ray + step) - camera_.Distort(ray - step)) / (2.0 * kStep);
  }
  return pixels;
}

double Renderer::ImageSpeed(const Tile& tile, const Visible& visible, TimeNs from, TimeNs to,
                            const geometry::SE3& T_world_cam_from, const geometry::SE3& T_world_cam_to) const {
  if (to <= from) return 0.0;
  const int right = tile.x0 + tile.width - 1;
  const int bottom = tile.y0 + tile.height - 1;
  const std::array<std::array<int, 2>, 5> places{{{tile.x0, tile.y0},
                                                  {right, tile.y0},
                                                  {tile.x0, bottom},
                                                  {right, bottom},
                                                  {(tile.x0 + right) / 2, (tile.y0 + bottom) / 2}}};
  std::array<Vector2d, 5> rays;
  std::array<Eigen::Matrix2d, 5> pixels;
  double least_pixels = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < places.size(); ++i) {
    rays[i] = Centre(places[i][0], places[i][1]);
    pixels[i] = PixelsPerStep(places[i][0], places[i][1]);
    least_pixels = std::min(least_pixels, pixels[i].colwise().norm().minCoeff());
  }
  const auto shift_px = [&](const Range& inverse_depths, const geometry::SE3& motion) {
    const Eigen::Matrix3d rotation = motion.RotationMatrix();
    double most = 0.0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      for (const double w : {inverse_depths.low, inverse_depths.high}) {
        most = std::max(most, (pixels[i] * Shift(rays[i], w, rotation, motion.translation())).norm());
      }
    }
    return most;
  };

  const RayBox box = Bounds(tile);
  const geometry::SE3 turn = T_world_cam_to.Inverse() * T_world_cam_from;
  double most = shift_px({0.0, 0.0}, turn);  // the sky
  Viewer before(scene_, from, T_world_cam_from);
  Viewer after(scene_, to, T_world_cam_to);
  for (const int index : visible.surfaces) {
    const geometry::SE3 motion = after.BodyInCamera(index) * before.BodyInCamera(index).Inverse();
    for (const bool forward : {true, false}) {
      // What moves by `shift` in all is at most half of that from the tile at one of the ends.
      Viewer& viewer = forward ? before : after;
      const geometry::SE3 way = forward ? motion : motion.Inverse();
      SurfaceView view;
      RayBox wide = Widened(box, 2.0 / least_pixels);
      for (int pass = 0; pass < 2; ++pass) {
        if (!viewer.View(index, wide, &view)) break;
        const Range range = InverseDepths(scene_.surfaces[index], view, viewer.BodyInCamera(index), wide);
        const double shift = shift_px(range, way);
        if (pass == 1) most = std::max(most, shift);
        wide = Widened(box, (0.5 * shift + 2.0) / least_pixels);
      }
    }
  }
  return most / ToSeconds(to - from);
}

}  // namespace evo::simulation
