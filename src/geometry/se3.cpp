#include "evo/geometry/se3.hpp"

#include <cmath>

namespace evo::geometry {

namespace {

// rad; below it the closed forms lose digits and the series are exact to rounding.
constexpr double kSmallAngle = 1e-5;

}  // namespace

namespace so3 {

Eigen::Matrix3d Hat(const Eigen::Vector3d& a) {
  Eigen::Matrix3d m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

Eigen::Quaterniond Exp(const Eigen::Vector3d& phi) {
  const double angle = phi.norm();
  const double scale = angle < kSmallAngle ? 0.5 - angle * angle / 48.0 : std::sin(0.5 * angle) / angle;
  return Eigen::Quaterniond(std::cos(0.5 * angle), scale * phi.x(), scale * phi.y(), scale * phi.z()).normalized();
}

Eigen::Vector3d Log(const Eigen::Quaterniond& rotation) {
  const double sign = rotation.w() < 0 ? -1.0 : 1.0;  // q and -q are the same rotation; this is the shorter one
  const Eigen::Vector3d v = sign * rotation.vec();
  const double sine = v.norm();
  if (sine < kSmallAngle) return 2.0 * v;
  return 2.0 * std::atan2(sine, sign * rotation.w()) / sine * v;
}

Eigen::Matrix3d LeftJacobian(const Eigen::Vector3d& phi) {
  const double angle2 = phi.squaredNorm();
  const double angle = std::sqrt(angle2);
  const Eigen::Matrix3d hat = Hat(phi);
  if (angle < kSmallAngle) return Eigen::Matrix3d::Identity() + 0.5 * hat + hat * hat / 6.0;
  return Eigen::Matrix3d::Identity() + (1.0 - std::cos(angle)) / angle2 * hat +
         (angle - std::sin(angle)) / (angle2 * angle) * hat * hat;
}

}  // namespace so3

SE3 SE3::Exp(const Vector6d& xi) {
  const Eigen::Vector3d phi = xi.tail<3>();
  return {so3::Exp(phi), so3::LeftJacobian(phi) * xi.head<3>()};
}

Vector6d SE3::Log() const {
  const Eigen::Vector3d phi = so3::Log(rotation_);
  Vector6d xi;
  xi << so3::LeftJacobian(phi).inverse() * translation_, phi;
  return xi;
}

Eigen::Matrix4d SE3::Matrix() const {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() = RotationMatrix();
  m.topRightCorner<3, 1>() = translation_;
  return m;
}

SE3 SE3::Inverse() const {
  const Eigen::Quaterniond inverse = rotation_.conjugate();
  return {inverse, -(inverse * translation_)};
}

SE3 SE3::operator*(const SE3& other) const {
  return {rotation_ * other.rotation_, rotation_ * other.translation_ + translation_};
}

Matrix6d Adjoint(const SE3& T) {
  Matrix6d adjoint = Matrix6d::Zero();
  adjoint.topLeftCorner<3, 3>() = adjoint.bottomRightCorner<3, 3>() = T.RotationMatrix();
  adjoint.topRightCorner<3, 3>() = so3::Hat(T.translation()) * T.RotationMatrix();
  return adjoint;
}

SE3 Interpolate(const SE3& a, const SE3& b, double s) {
  return {a.rotation().slerp(s, b.rotation()), (1.0 - s) * a.translation() + s * b.translation()};
}

}  // namespace evo::geometry
