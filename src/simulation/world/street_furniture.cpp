#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulation/world/street.hpp"

namespace evo::simulation {

namespace {

constexpr std::uint64_t kTreeStream = 0x74726565;  // "tree"
constexpr std::uint64_t kPoleStream = 0x706F6C65;  // "pole"
constexpr double kCanopyHeight = 4.6;              // m of trunk below a crown that hangs over the road
constexpr double kLampHeight = 7.0;                // m
constexpr double kLampReach = 2.2;                 // m over the road
constexpr double kLampEmission = 2.0;              // radiance
const Eigen::Vector3d kUp(0.0, -1.0, 0.0);

/// Level unit vector.
Eigen::Vector3d Level(double angle) { return {std::cos(angle), 0.0, std::sin(angle)}; }

/// Two crossed upright planes: a trunk or a pole for all directions of view.
void AddStem(SceneBuilder* builder, const Eigen::Vector3d& foot, double height, double thickness, double angle,
             const Material& material) {
  for (const double yaw : {0.0, 0.5 * std::numbers::pi}) {
    const Eigen::Vector3d across = thickness * Level(angle + yaw);
    builder->Add(foot + height * kUp - 0.5 * across, across, -(height + 0.2) * kUp, material,
                 Level(angle + yaw + 0.5 * std::numbers::pi));
  }
}

void AddCrown(SceneBuilder* builder, const Eigen::Vector3d& centre, double size, int texture, Random* random) {
  const int planes = 4 + random->Index(3);
  const double first = random->Uniform(0.0, std::numbers::pi);
  for (int i = 0; i < planes; ++i) {
    const double angle = first + std::numbers::pi * i / planes;
    const Eigen::Vector3d across = size * random->Uniform(0.85, 1.1) * Level(angle);
    const Eigen::Vector3d lean = Level(angle + 0.5 * std::numbers::pi);
    const Eigen::Vector3d down = size * (0.4 * random->Normal() * 0.5 * lean - kUp).normalized();
    const Eigen::Vector3d middle = centre + 0.08 * size * random->Normal() * lean;
    builder->Add(middle - 0.5 * (across + down), across, down,
                 builder->WholeTexture(texture, random->Uniform(0.7, 1.05)), lean);
  }
}

/// The mirror image of a street lamp in a wet road, drawn out by the road's roughness.
void AddReflection(SceneBuilder* builder, const Eigen::Vector3d& centre, double angle, int glow) {
  constexpr double kHeight = 5.0;  // m
  Material material = builder->WholeTexture(glow);
  material.emission = kLampEmission;
  AddStem(builder, centre - 0.5 * kHeight * kUp, kHeight, 0.8, angle, material);
}

}  // namespace

void AddTrees(const StreetContext& context) {
  Random random(context.seed, kTreeStream);
  const StreetPlan& plan = context.plan;
  const double length = plan.end() - plan.begin();
  const int count = static_cast<int>(std::lround(context.options.trees_per_100_m * length / 100.0));
  if (count == 0) return;
  const int crowns[] = {context.builder.Add(PaintFoliage(random)), context.builder.Add(PaintFoliage(random))};
  const int bark = context.builder.Add(PaintBark(random));
  for (int i = 0; i < count; ++i) {
    const double s = plan.begin() + (i + random.Uniform(0.1, 0.9)) * length / count;
    const int side = random.Chance(0.5) ? 1 : -1;
    double size = random.Uniform(3.0, 4.4);
    double trunk = random.Uniform(2.4, 3.2);
    const double angle = random.Uniform(0.0, std::numbers::pi);
    // The crown keeps clear of the camera's path.
    const double lateral = side * std::max(side * plan.kerb(side) + 0.8, 1.2 + 0.6 * size);
    const Eigen::Vector3d foot = plan.PointAt(s, lateral, kKerbHeight);
    if (!plan.IsClearOfJunctions(s, s, 1.0)) continue;
    const bool canopy = context.options.canopy > 0.0 && random.Chance(context.options.canopy);
    if (canopy) size *= 1.9, trunk = kCanopyHeight;
    const Eigen::Vector3d reach = canopy ? (-0.3 * size * side * plan.Right(s)).eval() : Eigen::Vector3d::Zero();
    AddStem(&context.builder, foot, trunk + 0.4, 0.32, angle, context.builder.WholeTexture(bark));
    AddCrown(&context.builder, foot + reach + (trunk + 0.42 * size) * kUp, size, crowns[random.Index(2)], &random);
  }
}

void AddPoles(const StreetContext& context) {
  Random random(context.seed, kPoleStream);
  const StreetPlan& plan = context.plan;
  const double length = plan.end() - plan.begin();
  const int count = static_cast<int>(std::lround(context.options.poles_per_100_m * length / 100.0));
  if (count == 0) return;
  SceneBuilder& builder = context.builder;
  const int metal = builder.Add(PaintPlain(random, 0.35));
  const int glow = context.options.wetness > 0.0 ? builder.Add(PaintGlow()) : -1;
  const int signs[] = {builder.Add(PaintTrafficSign(random)), builder.Add(PaintTrafficSign(random)),
                       builder.Add(PaintTrafficSign(random))};
  for (int i = 0; i < count; ++i) {
    const double s = plan.begin() + (i + random.Uniform(0.3, 0.7)) * length / count;
    const int side = i % 2 == 0 ? 1 : -1;
    const int sign = random.Chance(0.5) ? random.Index(3) : -1;
    if (!plan.IsClearOfJunctions(s, s, 0.5)) continue;
    const Eigen::Vector3d foot = plan.PointAt(s, plan.kerb(side) + side * 0.3, kKerbHeight);
    const Eigen::Vector3d forward = plan.Forward(s);
    const Eigen::Vector3d out = -side * plan.Right(s);
    const Material material = builder.WholeTexture(metal, random.Uniform(0.4, 1.6));
    AddStem(&builder, foot, kLampHeight, 0.14, plan.Heading(s), material);
    const Eigen::Vector3d head = foot + kLampHeight * kUp + kLampReach * out;
    builder.Add(foot + kLampHeight * kUp, kLampReach * out, -0.1 * kUp, material, forward);
    Material lamp = builder.WholeTexture(metal);
    if (context.night) {
      lamp.emission = kLampEmission;
      context.builder.lighting().lamps.push_back({head, context.options.lamp_intensity});
      if (glow >= 0) AddReflection(&builder, foot - kLampHeight * kUp + kLampReach * out, plan.Heading(s), glow);
    }
    builder.Add(head - 0.35 * out - 0.15 * forward, 0.7 * out, 0.3 * forward, lamp, -kUp);
    if (sign < 0) continue;
    const Eigen::Vector3d right = plan.Right(s);
    builder.Add(foot + 2.8 * kUp - 0.35 * right - 0.1 * forward, 0.7 * right, -0.7 * kUp,
                builder.WholeTexture(signs[sign]), -forward);
  }
}

}  // namespace evo::simulation
