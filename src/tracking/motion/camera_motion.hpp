#pragma once

#include <Eigen/Core>

#include "tracking/motion/lens_grid.hpp"

namespace evo::tracking {

/// Where a camera heads and how fast it turns, and what that does to the image.
struct CameraMotion {
  using Tangents = Eigen::Matrix<double, 3, 2>;
  using Step = Eigen::Matrix<double, 5, 1>;  ///< of the direction along both tangents, and of the turn rate

  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d turn_rate = Eigen::Vector3d::Zero();  ///< of the world about the camera, rad/s

  /// Image motion, px/s, of a point of inverse depth 1.
  Eigen::Vector2d Away(const PixelGeometry& pixel) const {
    return pixel.by_normalized * (direction.z() * pixel.normalized - direction.head<2>());
  }
  /// Image motion, px/s, of a resting point of this inverse depth.
  Eigen::Vector2d Flow(const PixelGeometry& pixel, double inverse_depth) const {
    return pixel.by_rotation * turn_rate + inverse_depth * Away(pixel);
  }
  /// The derivative of Away by the direction, on the plane z = 1 instead of in px.
  static Eigen::Matrix<double, 2, 3> AwayByDirection(const PixelGeometry& pixel) {
    Eigen::Matrix<double, 2, 3> by_direction;
    by_direction << -Eigen::Matrix2d::Identity(), pixel.normalized;
    return by_direction;
  }
  /// What the camera's translation adds to a flow, px/s.
  Eigen::Vector2d WithoutTurn(const PixelGeometry& pixel, const Eigen::Vector2d& flow) const {
    return flow - pixel.by_rotation * turn_rate;
  }
  /// Two directions perpendicular to `direction` and to one another.
  Tangents DirectionTangents() const;
  CameraMotion Moved(const Tangents& tangents, const Step& step) const;
};

/// What is left of a flow across the line along which a motion's translation moves the point, px/s.
struct FlowResidual {
  double value;
  CameraMotion::Step derivative;  ///< by a step of the motion
};

/// Where CameraMotion::Away is shorter than `shortest_away` (px/s) the line's direction means little, and the residual
/// and its derivative fade to nothing.
FlowResidual ResidualOf(const Eigen::Vector2d& flow, const PixelGeometry& pixel, const CameraMotion& motion,
                        const CameraMotion::Tangents& tangents, double shortest_away);

}  // namespace evo::tracking
