#include "simulation/world/scene.hpp"

#include <cmath>
#include <numbers>

namespace evo::simulation {

double Flicker(const Lighting& lighting, TimeNs t) {
  return 1.0 + lighting.flicker_depth * std::sin(2.0 * std::numbers::pi * lighting.flicker_hz * ToSeconds(t));
}

geometry::SE3 BodyPose(const Scene& scene, int body, TimeNs t) {
  return body == 0 ? geometry::SE3() : scene.bodies[body].T_world_body(t);
}

}  // namespace evo::simulation
