#include "evaluation/trajectory/projection.hpp"

#include <cmath>

namespace evo::evaluation {

geometry::SE3 Project(const geometry::SE3& T_world_cam, const std::string& plane) {
  if (plane == "none") return T_world_cam;
  const Eigen::Matrix3d R = T_world_cam.RotationMatrix();
  const double cosine = std::hypot(R(0, 0), R(1, 0));
  const bool is_locked = cosine < 1e-12;  // gimbal lock: b is a right angle and c is set to 0
  Eigen::Vector3d angles;
  angles << (is_locked ? std::atan2(-R(1, 2), R(1, 1)) : std::atan2(R(2, 1), R(2, 2))), std::atan2(-R(2, 0), cosine),
      (is_locked ? 0.0 : std::atan2(R(1, 0), R(0, 0)));
  const int normal = plane == "xy" ? 2 : plane == "xz" ? 1 : 0;
  Eigen::Vector3d position = T_world_cam.translation();
  position[normal] = 0.0;
  return {geometry::so3::Exp(angles[normal] * Eigen::Vector3d::Unit(normal)), position};
}

}  // namespace evo::evaluation
