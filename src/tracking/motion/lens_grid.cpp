#include "tracking/motion/lens_grid.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace evo::tracking {

namespace {

constexpr double kStep = 1e-4;  // on the plane z = 1, of numeric derivatives

}  // namespace

LensGrid::Point LensGrid::MakePoint(const geometry::Camera& camera, const Eigen::Vector2d& pixel) {
  Point point;
  const auto x = camera.Undistort(pixel);
  if (!x) return point;
  point.normalized = *x;
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(axis);
    point.by_normalized.col(axis) = (camera.Distort(*x + step) - camera.Distort(*x - step)) / (2.0 * kStep);
  }
  point.by_pixel = point.by_normalized.inverse();
  return point;
}

LensGrid::LensGrid(const geometry::Camera& camera)
    : focal_px_(camera.focal_px()), columns_(camera.width() / kSpacingPx + 2), rows_(camera.height() / kSpacingPx + 2) {
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      points_.push_back(MakePoint(camera, Eigen::Vector2d(column, row) * kSpacingPx));
    }
  }
}

PixelGeometry LensGrid::At(const Eigen::Vector2d& pixel) const {
  const int column = std::clamp(static_cast<int>(std::lround(pixel.x() / kSpacingPx)), 0, columns_ - 1);
  const int row = std::clamp(static_cast<int>(std::lround(pixel.y() / kSpacingPx)), 0, rows_ - 1);
  const Point& point = points_[static_cast<std::size_t>(row * columns_ + column)];
  PixelGeometry geometry;
  geometry.normalized = point.normalized + point.by_pixel * (pixel - Eigen::Vector2d(column, row) * kSpacingPx);
  geometry.by_normalized = point.by_normalized;
  const double x = geometry.normalized.x();
  const double y = geometry.normalized.y();
  Eigen::Matrix<double, 2, 3> turned;  // of the point on the plane z = 1, for a turn about each axis
  turned << -x * y, 1.0 + x * x, -y, -1.0 - y * y, x * y, x;
  geometry.by_rotation = point.by_normalized * turned;
  return geometry;
}

}  // namespace evo::tracking
