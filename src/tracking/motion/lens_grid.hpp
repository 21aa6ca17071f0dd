#pragma once

#include <Eigen/Core>
#include <vector>

#include "evo/geometry/camera.hpp"

namespace evo::tracking {

/// What the lens does around one pixel. All zero where the lens model has no inverse.
struct PixelGeometry {
  bool known() const { return !by_normalized.isZero(0.0); }

  Eigen::Vector2d normalized = Eigen::Vector2d::Zero();                           ///< on the plane z = 1
  Eigen::Matrix2d by_normalized = Eigen::Matrix2d::Zero();                        ///< px for a unit on that plane
  Eigen::Matrix<double, 2, 3> by_rotation = Eigen::Matrix<double, 2, 3>::Zero();  ///< px for a turn of the world, rad
};

/// The same for every pixel, tabulated every few pixels, so that it may be asked for each feature in each frame.
class LensGrid {
 public:
  static constexpr int kSpacingPx = 4;

  explicit LensGrid(const geometry::Camera& camera);

  double focal_px() const { return focal_px_; }
  /// By the derivative at the nearest grid point.
  PixelGeometry At(const Eigen::Vector2d& pixel) const;

 private:
  /// As small as can be, so that all stay in the cache. Zero where not known.
  struct Point {
    Eigen::Vector2d normalized = Eigen::Vector2d::Zero();
    Eigen::Matrix2d by_normalized = Eigen::Matrix2d::Zero();
    Eigen::Matrix2d by_pixel = Eigen::Matrix2d::Zero();  // its inverse
  };

  static Point MakePoint(const geometry::Camera& camera, const Eigen::Vector2d& pixel);

  double focal_px_;
  int columns_;
  int rows_;
  std::vector<Point> points_;
};

}  // namespace evo::tracking
