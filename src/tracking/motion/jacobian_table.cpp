#include "tracking/motion/jacobian_table.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace evo::tracking {

namespace {

constexpr double kDifferenceStep = 1e-4;  // of numeric derivatives on the plane z = 1: 0.02 to 0.1 px

}  // namespace

JacobianTable::Point JacobianTable::MakePoint(const geometry::Camera& camera, const Eigen::Vector2d& pixel) {
  Point point;
  const auto x = camera.Undistort(pixel);
  if (!x) return point;
  point.normalized = *x;
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector2d step = kDifferenceStep * Eigen::Vector2d::Unit(axis);
    point.J_pixel_normalized.col(axis) =
        (camera.Distort(*x + step) - camera.Distort(*x - step)) / (2.0 * kDifferenceStep);
  }
  point.J_normalized_pixel = point.J_pixel_normalized.inverse();
  return point;
}

JacobianTable::JacobianTable(const geometry::Camera& camera)
    : focal_px_(camera.focal_px()), columns_(camera.width() / kSpacingPx + 2), rows_(camera.height() / kSpacingPx + 2) {
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      points_.push_back(MakePoint(camera, Eigen::Vector2d(column, row) * kSpacingPx));
    }
  }
}

PixelJacobians JacobianTable::Lookup(const Eigen::Vector2d& pixel) const {
  const int column = std::clamp(static_cast<int>(std::lround(pixel.x() / kSpacingPx)), 0, columns_ - 1);
  const int row = std::clamp(static_cast<int>(std::lround(pixel.y() / kSpacingPx)), 0, rows_ - 1);
  const Point& point = points_[static_cast<std::size_t>(row * columns_ + column)];
  PixelJacobians jacobians;
  jacobians.normalized =
      point.normalized + point.J_normalized_pixel * (pixel - Eigen::Vector2d(column, row) * kSpacingPx);
  jacobians.J_pixel_normalized = point.J_pixel_normalized;
  const double x = jacobians.normalized.x();
  const double y = jacobians.normalized.y();
  // The rotational part of the motion field (Longuet-Higgins and Prazdny 1980), for a rotation of the world.
  Eigen::Matrix<double, 2, 3> J_normalized_rotation;
  J_normalized_rotation << -x * y, 1.0 + x * x, -y, -1.0 - y * y, x * y, x;
  jacobians.J_pixel_rotation = point.J_pixel_normalized * J_normalized_rotation;
  return jacobians;
}

}  // namespace evo::tracking
