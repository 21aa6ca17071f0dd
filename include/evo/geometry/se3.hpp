#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace evo::geometry {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

namespace so3 {

/// The 3x3 matrix with Hat(a) * b = a x b.
Eigen::Matrix3d Hat(const Eigen::Vector3d& a);
/// Rodrigues' formula; `phi` is the axis times the angle in rad.
Eigen::Quaterniond Exp(const Eigen::Vector3d& phi);
/// The axis times the angle in rad, the angle in [0, pi].
Eigen::Vector3d Log(const Eigen::Quaterniond& rotation);
/// J with Exp(phi + d) ~ Exp(J d) Exp(phi) for small d.
Eigen::Matrix3d LeftJacobian(const Eigen::Vector3d& phi);

}  // namespace so3

/// A rigid motion. T_a_b takes coordinates in frame b to frame a: T_a_c = T_a_b * T_b_c.
class SE3 {
 public:
  SE3() = default;
  /// Normalises `rotation`.
  SE3(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& translation)
      : rotation_(rotation.normalized()), translation_(translation) {}

  /// The exponential of a twist xi = (rho, phi), translation first (m, rad), as in D. Zhu's equation 1.
  static SE3 Exp(const Vector6d& xi);
  Vector6d Log() const;

  const Eigen::Quaterniond& rotation() const { return rotation_; }
  const Eigen::Vector3d& translation() const { return translation_; }
  Eigen::Matrix3d RotationMatrix() const { return rotation_.toRotationMatrix(); }
  Eigen::Matrix4d Matrix() const;

  SE3 Inverse() const;
  SE3 operator*(const SE3& other) const;
  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const { return rotation_ * point + translation_; }

 private:
  Eigen::Quaterniond rotation_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation_ = Eigen::Vector3d::Zero();
};

/// Ad(T) for twists (translation, rotation): T Exp(xi) = Exp(Ad(T) xi) T.
Matrix6d Adjoint(const SE3& T);

/// The motion between `a` (s = 0) and `b` (s = 1): spherical interpolation of the rotation, linear interpolation of the
/// translation.
SE3 Interpolate(const SE3& a, const SE3& b, double s);

}  // namespace evo::geometry
