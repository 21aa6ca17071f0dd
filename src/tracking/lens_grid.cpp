#include "evo/tracking/lens_grid.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace evo {

namespace {

constexpr double kStep = 1e-4;  // on the plane z = 1, of numeric derivatives

PixelGeometry GeometryAt(const Camera& camera, const Eigen::Vector2d& pixel) {
  PixelGeometry geometry;
  const auto x = camera.Undistort(pixel);
  if (!x) return geometry;
  geometry.normalized = *x;
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(axis);
    geometry.by_normalized.col(axis) = (camera.Distort(*x + step) - camera.Distort(*x - step)) / (2.0 * kStep);
  }
  const Eigen::Vector3d ray = x->homogeneous();
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d turned = Eigen::Vector3d::Unit(axis).cross(ray);
    geometry.by_rotation.col(axis) = geometry.by_normalized * (turned.head<2>() - *x * turned.z());
  }
  return geometry;
}

}  // namespace

LensGrid::LensGrid(const Camera& camera)
    : focal_px_(camera.focal_px()), columns_(camera.width() / kSpacingPx + 2), rows_(camera.height() / kSpacingPx + 2) {
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      const PixelGeometry geometry = GeometryAt(camera, Eigen::Vector2d(column, row) * kSpacingPx);
      const bool known = geometry.known();
      Point point{geometry, Eigen::Matrix2d::Zero()};
      if (known) point.by_pixel = geometry.by_normalized.inverse();
      points_.push_back(point);
    }
  }
}

PixelGeometry LensGrid::At(const Eigen::Vector2d& pixel) const {
  const int column = std::clamp(static_cast<int>(std::lround(pixel.x() / kSpacingPx)), 0, columns_ - 1);
  const int row = std::clamp(static_cast<int>(std::lround(pixel.y() / kSpacingPx)), 0, rows_ - 1);
  const Point& point = points_[static_cast<std::size_t>(row * columns_ + column)];
  PixelGeometry geometry = point.geometry;
  geometry.normalized += point.by_pixel * (pixel - Eigen::Vector2d(column, row) * kSpacingPx);
  return geometry;
}

}  // namespace evo
