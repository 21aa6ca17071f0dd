#include "evo/geometry/camera.hpp"

#include <Eigen/LU>
#include <cmath>

namespace evo::geometry {

namespace {

constexpr int kNewtonIterations = 30;     // a handful suffice; wide lenses need a dozen near their border
constexpr double kTolerance = 1e-12;      // of a step, normalized: rounding
constexpr double kMaxResidual = 1e-7;     // normalized: the iteration has not converged
constexpr double kMaxAngleMargin = 1e-3;  // rad short of 90 degrees, where the plane z = 1 ends

using Eigen::Matrix2d;
using Eigen::Vector2d;

/// The Brown-Conrady model; `jacobian` may be null.
Vector2d RadTan(const std::array<double, 5>& k, const Vector2d& p, Matrix2d* jacobian) {
  const double x = p.x();
  const double y = p.y();
  const double r2 = p.squaredNorm();
  const double radial = 1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
  if (jacobian) {
    const double slope = 2.0 * (k[0] + r2 * (2.0 * k[1] + r2 * 3.0 * k[4]));  // d radial / d x = slope * x
    (*jacobian)(0, 0) = radial + slope * x * x + 2.0 * k[2] * y + 6.0 * k[3] * x;
    (*jacobian)(0, 1) = slope * x * y + 2.0 * k[2] * x + 2.0 * k[3] * y;
    (*jacobian)(1, 0) = slope * x * y + 2.0 * k[2] * x + 2.0 * k[3] * y;
    (*jacobian)(1, 1) = radial + slope * y * y + 6.0 * k[2] * y + 2.0 * k[3] * x;
  }
  return {x * radial + 2.0 * k[2] * x * y + k[3] * (r2 + 2.0 * x * x),
          y * radial + k[2] * (r2 + 2.0 * y * y) + 2.0 * k[3] * x * y};
}

double EquidistantRadius(const std::array<double, 5>& k, double theta) {
  const double t2 = theta * theta;
  return theta * (1.0 + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3]))));
}

double EquidistantSlope(const std::array<double, 5>& k, double theta) {
  const double t2 = theta * theta;
  return 1.0 + t2 * (3.0 * k[0] + t2 * (5.0 * k[1] + t2 * (7.0 * k[2] + t2 * 9.0 * k[3])));
}

std::optional<Vector2d> UndistortRadTan(const std::array<double, 5>& k, const Vector2d& distorted) {
  Vector2d p = distorted;
  for (int i = 0; i < kNewtonIterations; ++i) {
    Matrix2d jacobian;
    const Vector2d residual = RadTan(k, p, &jacobian) - distorted;
    // The lens model folds: beyond the fold its inverse is another branch, not the observed ray.
    if (!(jacobian.determinant() > 0.0 && jacobian.trace() > 0.0)) return std::nullopt;
    const Vector2d step = jacobian.inverse() * residual;
    p -= step;
    if (step.squaredNorm() < kTolerance * kTolerance) break;
  }
  if (!((RadTan(k, p, nullptr) - distorted).norm() < kMaxResidual)) return std::nullopt;
  return p;
}

std::optional<Vector2d> UndistortEquidistant(const std::array<double, 5>& k, const Vector2d& distorted) {
  const double radius = distorted.norm();
  if (radius < 1e-12) return distorted;
  double theta = radius;
  for (int i = 0; i < kNewtonIterations; ++i) {
    const double slope = EquidistantSlope(k, theta);
    if (!(slope > 0.0)) return std::nullopt;
    const double step = (EquidistantRadius(k, theta) - radius) / slope;
    theta -= step;
    if (std::abs(step) < kTolerance) break;
  }
  if (!(std::abs(EquidistantRadius(k, theta) - radius) < kMaxResidual)) return std::nullopt;
  if (!(theta > 0.0 && theta < 0.5 * M_PI - kMaxAngleMargin)) return std::nullopt;  // not in front of the camera
  return distorted * (std::tan(theta) / radius);
}

}  // namespace

Calibration Rectified(const Calibration& calibration) {
  Calibration ideal = calibration;
  ideal.distortion = Distortion::kRadTan;  // a pinhole without coefficients, which equidistant is not
  ideal.coefficients = {};
  return ideal;
}

Vector2d Camera::Distort(const Vector2d& normalized) const {
  const auto& c = calibration_;
  Vector2d distorted;
  if (c.distortion == Distortion::kRadTan) {
    distorted = RadTan(c.coefficients, normalized, nullptr);
  } else {
    const double r = normalized.norm();
    distorted = r < 1e-12 ? normalized : Vector2d(normalized * (EquidistantRadius(c.coefficients, std::atan(r)) / r));
  }
  return {c.fx * distorted.x() + c.cx, c.fy * distorted.y() + c.cy};
}

std::optional<Vector2d> Camera::Undistort(const Vector2d& pixel) const {
  const auto& c = calibration_;
  const Vector2d distorted((pixel.x() - c.cx) / c.fx, (pixel.y() - c.cy) / c.fy);
  return c.distortion == Distortion::kRadTan ? UndistortRadTan(c.coefficients, distorted)
                                             : UndistortEquidistant(c.coefficients, distorted);
}

bool Camera::Contains(const Vector2d& pixel, double margin) const {
  return pixel.x() >= margin && pixel.y() >= margin && pixel.x() <= width() - 1 - margin &&
         pixel.y() <= height() - 1 - margin;
}

}  // namespace evo::geometry
