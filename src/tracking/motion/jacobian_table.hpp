#pragma once

#include <Eigen/Core>
#include <vector>

#include "evo/geometry/camera.hpp"

namespace evo::tracking {

/// The lens around one pixel, to the first order. All zero where the lens model has no inverse.
struct PixelJacobians {
  bool known() const { return !J_pixel_normalized.isZero(0.0); }

  Eigen::Vector2d normalized = Eigen::Vector2d::Zero();          ///< the pixel's ray, on the plane z = 1
  Eigen::Matrix2d J_pixel_normalized = Eigen::Matrix2d::Zero();  ///< px for a unit on that plane
  Eigen::Matrix<double, 2, 3> J_pixel_rotation =
      Eigen::Matrix<double, 2, 3>::Zero();  ///< px/rad, of the world about the camera
};

/// PixelJacobians of the whole image, tabulated every few pixels: each frame asks for those of every feature.
class JacobianTable {
 public:
  static constexpr int kSpacingPx = 4;  ///< the lens is linear to 0.1 px over half of this

  explicit JacobianTable(const geometry::Camera& camera);

  double focal_px() const { return focal_px_; }
  /// Extrapolates from the nearest grid point to `pixel`.
  PixelJacobians Lookup(const Eigen::Vector2d& pixel) const;

 private:
  /// Kept small, so that all points stay in the cache. Zero where the lens model has no inverse.
  struct Point {
    Eigen::Vector2d normalized = Eigen::Vector2d::Zero();
    Eigen::Matrix2d J_pixel_normalized = Eigen::Matrix2d::Zero();
    Eigen::Matrix2d J_normalized_pixel = Eigen::Matrix2d::Zero();
  };

  static Point MakePoint(const geometry::Camera& camera, const Eigen::Vector2d& pixel);

  double focal_px_;
  int columns_;
  int rows_;
  std::vector<Point> points_;
};

}  // namespace evo::tracking
