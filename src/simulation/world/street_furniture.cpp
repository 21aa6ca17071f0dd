#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulation/world/street.hpp"

namespace evo::simulation {

namespace {

constexpr std::uint64_t kTreeStream = 0x74726565;
constexpr std::uint64_t kPoleStream = 0x706F6C65;
constexpr double kLampHeight = 7.0;
constexpr double kLampReach = 2.2;  // over the road
constexpr double kLampIntensity = 6.0;
const Eigen::Vector3d kUp(0.0, -1.0, 0.0);

Eigen::Vector3d Level(double angle) { return {std::cos(angle), 0.0, std::sin(angle)}; }

// Two crossed upright planes: a trunk or a pole, seen from all sides.
void AddStem(SceneBuilder* builder, const Eigen::Vector3d& foot, double height, double thickness, double angle,
             const Look& look) {
  for (const double turn : {0.0, 0.5 * std::numbers::pi}) {
    const Eigen::Vector3d across = thickness * Level(angle + turn);
    builder->Add(foot + height * kUp - 0.5 * across, across, -(height + 0.2) * kUp, look,
                 Level(angle + turn + 0.5 * std::numbers::pi));
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
    builder->Add(middle - 0.5 * (across + down), across, down, builder->Whole(texture, random->Uniform(0.7, 1.05)),
                 lean);
  }
}

}  // namespace

void AddTrees(const StreetTask& task) {
  Random random(task.seed, kTreeStream);
  const StreetPlan& plan = task.plan;
  const double length = plan.end() - plan.begin();
  const int count = static_cast<int>(std::lround(task.options.trees_per_100_m * length / 100.0));
  if (count == 0) return;
  const int crowns[] = {task.builder.Add(PaintFoliage(random)), task.builder.Add(PaintFoliage(random))};
  const int bark = task.builder.Add(PaintBark(random));
  for (int i = 0; i < count; ++i) {
    const double s = plan.begin() + (i + random.Uniform(0.1, 0.9)) * length / count;
    const int side = random.Chance(0.5) ? 1 : -1;
    const double size = random.Uniform(3.0, 4.4);
    const double trunk = random.Uniform(2.4, 3.2);
    const double angle = random.Uniform(0.0, std::numbers::pi);
    // Its crown keeps away from the camera.
    const double lateral = side * std::max(side * plan.kerb(side) + 0.8, 1.2 + 0.6 * size);
    const Eigen::Vector3d foot = plan.At(s, lateral, kKerbHeight);
    if (!plan.IsClearOfCrossings(s, s, 1.0)) continue;
    AddStem(&task.builder, foot, trunk + 0.4, 0.32, angle, task.builder.Whole(bark));
    AddCrown(&task.builder, foot + (trunk + 0.42 * size) * kUp, size, crowns[random.Index(2)], &random);
  }
}

void AddPoles(const StreetTask& task) {
  Random random(task.seed, kPoleStream);
  const StreetPlan& plan = task.plan;
  const double length = plan.end() - plan.begin();
  const int count = static_cast<int>(std::lround(task.options.poles_per_100_m * length / 100.0));
  if (count == 0) return;
  SceneBuilder& builder = task.builder;
  const int metal = builder.Add(PaintPlain(random, 0.35));
  const int signs[] = {builder.Add(PaintTrafficSign(random)), builder.Add(PaintTrafficSign(random)),
                       builder.Add(PaintTrafficSign(random))};
  for (int i = 0; i < count; ++i) {
    const double s = plan.begin() + (i + random.Uniform(0.3, 0.7)) * length / count;
    const int side = i % 2 == 0 ? 1 : -1;
    const int sign = random.Chance(0.5) ? random.Index(3) : -1;
    if (!plan.IsClearOfCrossings(s, s, 0.5)) continue;
    const Eigen::Vector3d foot = plan.At(s, plan.kerb(side) + side * 0.3, kKerbHeight);
    const Eigen::Vector3d forward = plan.Forward(s);
    const Eigen::Vector3d out = -side * plan.Right(s);
    const Look look = builder.Whole(metal, random.Uniform(0.4, 1.6));
    AddStem(&builder, foot, kLampHeight, 0.14, plan.Heading(s), look);
    const Eigen::Vector3d head = foot + kLampHeight * kUp + kLampReach * out;
    builder.Add(foot + kLampHeight * kUp, kLampReach * out, -0.1 * kUp, look, forward);
    Look lamp = builder.Whole(metal);
    if (task.night) {
      lamp.emission = 2.0;
      task.builder.lighting().lamps.push_back({head, kLampIntensity});
    }
    builder.Add(head - 0.35 * out - 0.15 * forward, 0.7 * out, 0.3 * forward, lamp, -kUp);
    if (sign < 0) continue;
    const Eigen::Vector3d right = plan.Right(s);
    builder.Add(foot + 2.8 * kUp - 0.35 * right - 0.1 * forward, 0.7 * right, -0.7 * kUp, builder.Whole(signs[sign]),
                -forward);
  }
}

}  // namespace evo::simulation
