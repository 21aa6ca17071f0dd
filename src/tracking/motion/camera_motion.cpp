#include "tracking/motion/camera_motion.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace evo::tracking {

CameraMotion::Tangents CameraMotion::DirectionTangents() const {
  Tangents tangents;
  tangents.col(0) = direction.unitOrthogonal();
  tangents.col(1) = direction.cross(tangents.col(0));
  return tangents;
}

CameraMotion CameraMotion::Retract(const Tangents& tangents, const Step& step) const {
  return {(direction + tangents * step.head<2>()).normalized(), angular_velocity + step.tail<3>()};
}

EpipolarResidual ComputeEpipolarResidual(const Eigen::Vector2d& flow, const PixelJacobians& pixel,
                                         const CameraMotion& motion, const CameraMotion::Tangents& tangents,
                                         double min_translational_flow) {
  const Eigen::Vector2d derotated = motion.Derotate(pixel, flow);
  const Eigen::Vector2d line = motion.TranslationalFlow(pixel);
  const double length = std::max(line.norm(), min_translational_flow);
  const Eigen::Vector2d normal(-line.y() / length, line.x() / length);
  EpipolarResidual residual;
  residual.value = normal.dot(derotated);
  // Rotating the line by an angle changes the residual by minus that angle times the flow along the line.
  const double along = line.dot(derotated) / length;
  const Eigen::RowVector2d J_across_normalized = normal.transpose() * pixel.J_pixel_normalized;
  const Eigen::RowVector3d J_across_direction = J_across_normalized * CameraMotion::DirectionJacobian(pixel);
  residual.jacobian.head<2>() = (-along / length) * (J_across_direction * tangents).transpose();
  residual.jacobian.tail<3>() = -(normal.transpose() * pixel.J_pixel_rotation).transpose();
  return residual;
}

}  // namespace evo::tracking
