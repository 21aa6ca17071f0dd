#pragma once

#include <Eigen/Core>
#include <optional>

#include "simulation/world/scene.hpp"

namespace evo::simulation {

/// The bonnet of the camera's own car as the camera sees it: a slightly convex mirror of clear coat over paint. The
/// scene is far compared with the bonnet, so that the mirrored rays count as rays from the camera's centre.
class BonnetMirror {
 public:
  explicit BonnetMirror(const Bonnet& bonnet);

  struct Reflection {
    Eigen::Vector2d ray;  ///< on the plane z = 1
    double reflectivity = 0.0;
  };
  /// Nothing for a ray (on the plane z = 1) that passes over the bonnet.
  std::optional<Reflection> Reflect(const Eigen::Vector2d& ray) const;

 private:
  Bonnet bonnet_;
};

}  // namespace evo::simulation
