#include "evo/geometry/triangulation.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace evo::geometry {

namespace {

constexpr double kMinSine2 = 1e-14;  // squared sine of the angle between two rays: parallel to rounding
constexpr int kIterations = 5;       // converged to rounding from the point nearest to the rays

/// The point with the least sum of squared distances to all rays.
std::optional<Eigen::Vector3d> NearestToRays(std::span<const View> views) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const View& view : views) {
    const SE3 T_world_cam = view.T_cam_world.Inverse();
    const Eigen::Vector3d ray = (T_world_cam.rotation() * view.x.homogeneous()).normalized();
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - ray * ray.transpose();
    normal += across;
    right += across * T_world_cam.translation();
  }
  if (!(normal.determinant() > kMinSine2)) return std::nullopt;
  return normal.ldlt().solve(right);
}

/// One Gauss-Newton step on the reprojection error with its normal matrix `normal`. False behind a camera.
bool StepGaussNewton(std::span<const View> views, Eigen::Vector3d* point, Eigen::Matrix3d* normal) {
  normal->setZero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  for (const View& view : views) {
    const Eigen::Vector3d p = view.T_cam_world * *point;
    if (!(p.z() > 0.0)) return false;
    Eigen::Matrix<double, 2, 3> projection;
    projection << 1.0 / p.z(), 0.0, -p.x() / (p.z() * p.z()), 0.0, 1.0 / p.z(), -p.y() / (p.z() * p.z());
    const Eigen::Matrix<double, 2, 3> jacobian = projection * view.T_cam_world.RotationMatrix();
    *normal += jacobian.transpose() * jacobian;
    gradient += jacobian.transpose() * (view.x - p.head<2>() / p.z());
  }
  *point += normal->ldlt().solve(gradient);
  return point->allFinite();
}

}  // namespace

std::optional<PairDepths> TriangulatePair(const Eigen::Vector2d& x1, const Eigen::Vector2d& x2, const SE3& T_2_1) {
  const Eigen::Vector3d ray1 = T_2_1.rotation() * x1.homogeneous();
  const Eigen::Vector3d ray2 = x2.homogeneous();
  const Eigen::Vector3d& t = T_2_1.translation();
  // Equation 6 as [R x1, -x2] (Z1, Z2)^T = -t and its normal equations.
  const double a = ray1.squaredNorm();
  const double b = ray1.dot(ray2);
  const double c = ray2.squaredNorm();
  const double determinant = a * c - b * b;
  if (!(determinant > kMinSine2 * a * c)) return std::nullopt;
  const double right1 = -ray1.dot(t);
  const double right2 = ray2.dot(t);
  return PairDepths{(c * right1 + b * right2) / determinant, (b * right1 + a * right2) / determinant};
}

std::optional<TriangulatedPoint> TriangulateViews(std::span<const View> views) {
  if (views.size() < 2) return std::nullopt;
  const auto start = NearestToRays(views);
  if (!start) return std::nullopt;
  TriangulatedPoint result{*start, Eigen::Matrix3d::Zero()};
  Eigen::Matrix3d normal;
  for (int i = 0; i < kIterations; ++i) {
    if (!StepGaussNewton(views, &result.position_world, &normal)) return std::nullopt;
  }
  const Eigen::FullPivLU<Eigen::Matrix3d> inverter(normal);
  if (!inverter.isInvertible()) return std::nullopt;
  result.covariance = inverter.inverse();
  for (const View& view : views) {
    if (!((view.T_cam_world * result.position_world).z() > 0.0)) return std::nullopt;
  }
  return result;
}

}  // namespace evo::geometry
