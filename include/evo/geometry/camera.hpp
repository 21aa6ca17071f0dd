#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>

namespace evo::geometry {

enum class Distortion { kRadTan, kEquidistant };

/// The intrinsic calibration of one camera. Integer pixel coordinates are pixel centres.
struct Calibration {
  Distortion distortion = Distortion::kRadTan;
  int width = 0;                          ///< px
  int height = 0;                         ///< px
  double fx = 0, fy = 0, cx = 0, cy = 0;  ///< px
  /// radtan: k1 k2 p1 p2 k3 (D. C. Brown: Decentering Distortion of Lenses, 1966); equidistant: k1 k2 k3 k4
  /// (J. Kannala, S. S. Brandt: A Generic Camera Model, PAMI 2006, odd powers of the angle) and an unused 0.
  std::array<double, 5> coefficients{};
};

/// The same camera without distortion: a pinhole.
Calibration Rectified(const Calibration& calibration);

/// Pinhole camera with lens distortion: camera x right, y down, z forward.
class Camera {
 public:
  explicit Camera(const Calibration& calibration) : calibration_(calibration) {}

  const Calibration& calibration() const { return calibration_; }
  int width() const { return calibration_.width; }
  int height() const { return calibration_.height; }
  /// Mean of fx and fy, px.
  double focal_px() const { return 0.5 * (calibration_.fx + calibration_.fy); }

  /// Maps the normalized plane z = 1 (undistorted) to raw sensor pixels.
  Eigen::Vector2d Distort(const Eigen::Vector2d& normalized) const;
  /// Projects a point in camera coordinates, z > 0, to raw sensor pixels.
  Eigen::Vector2d Project(const Eigen::Vector3d& point_cam) const {
    return Distort(point_cam.head<2>() / point_cam.z());
  }
  /// Maps raw sensor pixels to the normalized plane z = 1 by Newton's method. Empty where the lens model has no
  /// inverse.
  std::optional<Eigen::Vector2d> Undistort(const Eigen::Vector2d& pixel) const;

  /// Whether a raw pixel lies on the sensor, `margin` px or more from its outermost pixel centres.
  bool Contains(const Eigen::Vector2d& pixel, double margin = 0.0) const;

 private:
  Calibration calibration_;
};

}  // namespace evo::geometry
