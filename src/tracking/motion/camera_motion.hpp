#pragma once

#include <Eigen/Core>

#include "tracking/motion/jacobian_table.hpp"

namespace evo::tracking {

/// Instantaneous motion of the camera, in the camera frame, and the motion field that it causes in the image (H. C.
/// Longuet-Higgins, K. Prazdny: The Interpretation of a Moving Retinal Image, Proc. R. Soc. B 1980).
struct CameraMotion {
  using Tangents = Eigen::Matrix<double, 3, 2>;
  using Step = Eigen::Matrix<double, 5, 1>;  ///< of the direction along both tangents, and of the angular velocity

  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();        ///< of the translation; a unit vector
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< of the world about the camera, rad/s

  /// Image velocity that the translation causes at a point of unit inverse depth, px/s.
  Eigen::Vector2d TranslationalFlow(const PixelJacobians& pixel) const {
    return pixel.J_pixel_normalized * (direction.z() * pixel.normalized - direction.head<2>());
  }
  /// Image velocity of a static point, px/s; its inverse depth is in units of the speed, 1/s.
  Eigen::Vector2d PredictFlow(const PixelJacobians& pixel, double inverse_depth) const {
    return pixel.J_pixel_rotation * angular_velocity + inverse_depth * TranslationalFlow(pixel);
  }
  /// Derivative of TranslationalFlow by the direction, on the plane z = 1 instead of in px.
  static Eigen::Matrix<double, 2, 3> DirectionJacobian(const PixelJacobians& pixel) {
    Eigen::Matrix<double, 2, 3> J_normalized_direction;
    J_normalized_direction << -Eigen::Matrix2d::Identity(), pixel.normalized;
    return J_normalized_direction;
  }
  /// The flow without the part that the rotation causes, px/s.
  Eigen::Vector2d Derotate(const PixelJacobians& pixel, const Eigen::Vector2d& flow) const {
    return flow - pixel.J_pixel_rotation * angular_velocity;
  }
  /// Orthonormal basis of the plane perpendicular to `direction`.
  Tangents DirectionTangents() const;
  /// The motion after a step in the tangent space.
  CameraMotion Retract(const Tangents& tangents, const Step& step) const;
};

/// Distance of a derotated flow from the epipolar line, along which a static point moves, px/s.
struct EpipolarResidual {
  double value;
  CameraMotion::Step jacobian;  ///< by a step of the motion
};

/// Where the translational flow is shorter than `min_translational_flow` (px/s) the epipolar line is ill defined; there
/// the residual and its Jacobian fade to zero.
EpipolarResidual ComputeEpipolarResidual(const Eigen::Vector2d& flow, const PixelJacobians& pixel,
                                         const CameraMotion& motion, const CameraMotion::Tangents& tangents,
                                         double min_translational_flow);

}  // namespace evo::tracking
