#pragma once

#include <algorithm>

#include "evo/simulation/pose_function.hpp"

namespace evo::simulation {

/// Largest change of the velocity (m/s) and of the angular velocity in the body frame (rad/s) within 2 ms.
struct VelocityStep {
  double linear = 0.0;
  double angular = 0.0;
};
inline VelocityStep LargestVelocityStep(const PoseFunction& T_world_cam, double from, double to) {
  constexpr double kStep = 0.002;
  VelocityStep step;
  Eigen::Vector3d last_velocity = Eigen::Vector3d::Zero(), last_rate = Eigen::Vector3d::Zero();
  bool first = true;
  for (double t = from; t < to; t += kStep) {
    const geometry::SE3 a = T_world_cam(FromSeconds(t)), b = T_world_cam(FromSeconds(t + kStep));
    const Eigen::Vector3d velocity = (b.translation() - a.translation()) / kStep;
    const Eigen::Vector3d rate = geometry::so3::Log(a.rotation().conjugate() * b.rotation()) / kStep;
    if (!first) {
      step.linear = std::max(step.linear, (velocity - last_velocity).norm());
      step.angular = std::max(step.angular, (rate - last_rate).norm());
    }
    last_velocity = velocity;
    last_rate = rate;
    first = false;
  }
  return step;
}

}  // namespace evo::simulation
