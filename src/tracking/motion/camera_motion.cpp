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

CameraMotion CameraMotion::Moved(const Tangents& tangents, const Step& step) const {
  return {(direction + tangents * step.head<2>()).normalized(), turn_rate + step.tail<3>()};
}

FlowResidual ResidualOf(const Eigen::Vector2d& flow, const PixelGeometry& pixel, const CameraMotion& motion,
                        const CameraMotion::Tangents& tangents, double shortest_away) {
  const Eigen::Vector2d translational = motion.WithoutTurn(pixel, flow);
  const Eigen::Vector2d away = motion.Away(pixel);
  const double length = std::max(away.norm(), shortest_away);
  const Eigen::Vector2d across(-away.y() / length, away.x() / length);
  FlowResidual residual;
  residual.value = across.dot(translational);
  // Turning the line by an angle takes that angle times the flow along it off the residual.
  const double along = away.dot(translational) / length;
  const Eigen::RowVector2d line = across.transpose() * pixel.by_normalized;
  const Eigen::RowVector3d by_direction = line * CameraMotion::AwayByDirection(pixel);
  residual.derivative.head<2>() = (-along / length) * (by_direction * tangents).transpose();
  residual.derivative.tail<3>() = -(across.transpose() * pixel.by_rotation).transpose();
  return residual;
}

}  // namespace evo::tracking
