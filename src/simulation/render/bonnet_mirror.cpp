#include "simulation/render/bonnet_mirror.hpp"

#include <algorithm>
#include <cmath>

namespace evo::simulation {

namespace {

// The shape of a bonnet: it falls off to its sides and to its front.
constexpr double kEdgeCurvature = 0.25;    // of its edge in the picture, on the plane z = 1
constexpr double kLateralCurvature = 0.3;  // of its normal
constexpr double kForwardTilt = 0.08;      // of its normal at the front edge
constexpr double kForwardCurvature = 0.1;
constexpr double kMinForward = 0.05;  // of a mirrored ray: none points backwards

}  // namespace

BonnetMirror::BonnetMirror(const Bonnet& bonnet) : bonnet_(bonnet) {}

std::optional<BonnetMirror::Reflection> BonnetMirror::Reflect(const Eigen::Vector2d& ray) const {
  const Eigen::Vector3d direction = bonnet_.R_vehicle_cam * ray.homogeneous().normalized();
  if (!(direction.z() > 0.0)) return {};
  const double across = direction.x() / direction.z();
  const double below = direction.y() / direction.z() - bonnet_.edge - kEdgeCurvature * across * across;
  if (below <= 0.0) return {};
  const Eigen::Vector3d normal =
      Eigen::Vector3d(kLateralCurvature * across, -1.0, kForwardTilt - kForwardCurvature * below).normalized();
  const double cosine = std::clamp(-direction.dot(normal), 0.0, 1.0);
  // Fresnel's reflection in Schlick's approximation (An Inexpensive BRDF Model, 1994).
  const double reflectivity = bonnet_.reflectivity + (1.0 - bonnet_.reflectivity) * std::pow(1.0 - cosine, 5.0);
  Eigen::Vector3d mirrored = bonnet_.R_vehicle_cam.conjugate() * (direction - 2.0 * direction.dot(normal) * normal);
  mirrored.z() = std::max(mirrored.z(), kMinForward);
  return Reflection{mirrored.head<2>() / mirrored.z(), reflectivity};
}

}  // namespace evo::simulation
