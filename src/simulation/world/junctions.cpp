#include <Eigen/Geometry>
#include <cmath>

#include "simulation/world/street.hpp"

namespace evo::simulation {

namespace {

constexpr std::uint64_t kStream = 0x63726F7373;  // "cross"
constexpr double kOverlap = 14.0;                // m that a side road extends beyond the junction's centre

}  // namespace

void AddJunctions(const StreetContext& context) {
  if (context.plan.junctions().empty()) return;
  Random random(context.seed, kStream);
  const double contrast = context.options.road_contrast;
  const int asphalt = context.builder.Add(PaintAsphalt(random, 1024, contrast));
  context.builder.SetContrast(contrast);
  const int pavement = context.builder.Add(PaintPavement(random));
  const int ground = context.builder.Add(PaintGround(random));
  context.builder.SetContrast(1.0);
  const int kerb = context.builder.Add(PaintKerb(random));
  const double width = context.plan.layout().width();
  const double strip = context.plan.pavement();
  const Eigen::Vector3d down = Eigen::Vector3d::UnitY();
  for (const StreetPlan::Junction& junction : context.plan.junctions()) {
    // Side roads lie below the main road, each at a depth of its own, so that no two coincide.
    double drop = 0.02 + 1.5 * std::abs(junction.forward.y());
    const auto add = [&](const Eigen::Vector3d& origin, const Eigen::Vector3d& u, const Eigen::Vector3d& v, int texture,
                         double texels_per_m, const Eigen::Vector3d& outwards) {
      Material material;
      material.texture = texture;
      material.texel_origin = {1024.0 * random.Uniform(), texture == kerb ? 0.0 : 1024.0 * random.Uniform()};
      material.texels = {u.norm() * texels_per_m, texture == kerb ? 16.0 : v.norm() * texels_per_m};
      context.builder.Add(origin, u, v, material, outwards);
    };
    for (const Eigen::Vector3d& arm : junction.arms) {
      const Eigen::Vector3d across = arm.cross(junction.forward.cross(junction.right)).normalized();
      const Eigen::Vector3d start = junction.centre + drop * down;
      add(start - kOverlap * arm - 0.5 * width * across, width * across, (kOverlap + kArmLength) * arm, asphalt,
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
    // Asphalt under the corners.
    const double half = 0.5 * width + strip + 8.0;
    const Eigen::Vector3d side = half * junction.right;
    const Eigen::Vector3d ahead = half * junction.forward;
    add(junction.centre + drop * down - side - ahead, 2.0 * side, 2.0 * ahead, asphalt, kRoadWidthTexels / width,
        -down);
  }
}

}  // namespace evo::simulation
