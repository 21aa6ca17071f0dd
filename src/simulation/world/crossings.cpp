#include <Eigen/Geometry>
#include <cmath>

#include "simulation/world/street.hpp"

namespace evo::simulation {

namespace {

constexpr std::uint64_t kStream = 0x63726F7373;
constexpr double kBack = 14.0;  // m that a side road reaches to the other side of the crossing's middle

}  // namespace

void AddCrossings(const StreetTask& task) {
  if (task.plan.crossings().empty()) return;
  Random random(task.seed, kStream);
  const int asphalt = task.builder.Add(PaintAsphalt(random, 1024));
  const int pavement = task.builder.Add(PaintPavement(random));
  const int ground = task.builder.Add(PaintGround(random));
  const int kerb = task.builder.Add(PaintKerb(random));
  const double width = task.plan.layout().width();
  const double strip = task.plan.pavement();
  const Eigen::Vector3d down = Eigen::Vector3d::UnitY();
  for (const StreetPlan::Crossing& crossing : task.plan.crossings()) {
    // Below the road that we drive on, each at a height of its own; deeper where a slope meets a turn.
    double drop = 0.02 + 1.5 * std::abs(crossing.forward.y());
    const auto add = [&](const Eigen::Vector3d& origin, const Eigen::Vector3d& u, const Eigen::Vector3d& v, int texture,
                         double texels_per_m, const Eigen::Vector3d& outwards) {
      Look look;
      look.texture = texture;
      look.texel_origin = {1024.0 * random.Uniform(), texture == kerb ? 0.0 : 1024.0 * random.Uniform()};
      look.texels = {u.norm() * texels_per_m, texture == kerb ? 16.0 : v.norm() * texels_per_m};
      task.builder.Add(origin, u, v, look, outwards);
    };
    for (const Eigen::Vector3d& arm : crossing.arms) {
      const Eigen::Vector3d across = arm.cross(crossing.forward.cross(crossing.right)).normalized();
      const Eigen::Vector3d start = crossing.centre + drop * down;
      add(start - kBack * arm - 0.5 * width * across, width * across, (kBack + kArmLength) * arm, asphalt,
          kRoadWidthTexels / width, -down);
      const double from = 0.5 * width + strip;
      for (const double side : {-1.0, 1.0}) {
        const Eigen::Vector3d edge = start + from * arm + 0.5 * side * width * across - kKerbHeight * down;
        const Eigen::Vector3d along = (kArmLength - from) * arm;
        add(edge, along, side * strip * across, pavement, 100.0, -down);
        add(edge, along, kKerbHeight * down, kerb, 100.0, -side * across);
        add(edge, side * strip * across, kKerbHeight * down, kerb, 100.0, -arm);
      }
      const double wide = width + 2.0 * strip + 40.0;
      add(start + from * arm - 0.5 * wide * across + 0.1 * down, wide * across, (kArmLength - from + 20.0) * arm,
          ground, 25.0, -down);
      drop += 0.004;
    }
    // Asphalt around, for the corners.
    const double half = 0.5 * width + strip + 8.0;
    const Eigen::Vector3d side = half * crossing.right;
    const Eigen::Vector3d ahead = half * crossing.forward;
    add(crossing.centre + drop * down - side - ahead, 2.0 * side, 2.0 * ahead, asphalt, kRoadWidthTexels / width,
        -down);
  }
}

}  // namespace evo::simulation
