#include <Eigen/Geometry>
#include <cmath>

#include "simulation/world/street.hpp"

namespace evo::simulation {

namespace {

constexpr std::uint64_t kStream = 0x6C6F727279;  // "lorry"
// m
constexpr double kLength = 9.5;
constexpr double kWidth = 2.5;
constexpr double kCabLength = 2.0;
constexpr double kCabHeight = 2.9;
constexpr double kBoxBottom = 1.0;
constexpr double kBoxTop = 3.6;

/// The textures of a lorry.
struct LorryTextures {
  int canvas = 0;
  int cab = 0;
  int chassis = 0;
  int rear = 0;
};

/// Adds the sides, both ends and the roof of a box between two heights and two lengths ahead of the lorry's centre.
void AddHull(SceneBuilder* builder, int body, const Eigen::Vector4d& bounds, const Eigen::Vector2i& textures,
             double tone) {
  const double rear = bounds[0], front = bounds[1], bottom = bounds[2], top = bounds[3];
  const auto add = [&](const Eigen::Vector3d& origin, const Eigen::Vector3d& u, const Eigen::Vector3d& v, int texture,
                       const Eigen::Vector3d& outwards) {
    Material material = builder->WholeTexture(texture, tone);
    material.body = body;
    builder->Add(origin, u, v, material, outwards);
  };
  const Eigen::Vector3d down(0.0, top - bottom, 0.0);
  for (const double side : {-1.0, 1.0}) {
    const double x = 0.5 * side * kWidth;
    // Lettering runs from left to right for the viewer.
    add({x, -top, side < 0.0 ? front : rear}, {0.0, 0.0, side < 0.0 ? rear - front : front - rear}, down, textures[0],
        {side, 0.0, 0.0});
  }
  for (const double z : {rear, front}) {
    const double side = z == rear ? 1.0 : -1.0;
    add({-0.5 * side * kWidth, -top, z}, {side * kWidth, 0.0, 0.0}, down, textures[1], {0.0, 0.0, -side});
  }
  add({-0.5 * kWidth, -top, rear}, {kWidth, 0.0, 0.0}, {0.0, 0.0, front - rear}, textures[1], {0.0, -1.0, 0.0});
}

}  // namespace

void AddLorry(const StreetContext& context, const std::function<double(TimeNs)>& camera_distance_m) {
  if (!context.options.lorry || !camera_distance_m) return;
  Random random(context.seed, kStream);
  SceneBuilder& builder = context.builder;
  const LorryTextures textures{builder.Add(PaintPlacard(random)), builder.Add(PaintCarPaint(random)),
                               builder.Add(PaintChassis()), builder.Add(PaintPlain(random, 0.5))};
  // It is ahead at first and falls back, or the other way round.
  const double ratio = random.Uniform(0.85, 1.2);
  const double gap = ratio < 1.0 ? random.Uniform(4.0, 14.0) : random.Uniform(-8.0, 6.0);
  Body body;
  body.T_world_body = [=, plan = context.shared_plan](TimeNs t) {
    const double distance = ratio * camera_distance_m(t) + gap;
    Eigen::Matrix3d axes;
    axes << plan->Right(distance), plan->Forward(distance).cross(plan->Right(distance)), plan->Forward(distance);
    return geometry::SE3(Eigen::Quaterniond(axes), plan->PointAt(distance, plan->other_lane(), 0.0));
  };
  const int index = builder.AddBody(std::move(body));
  const double rear = -0.5 * kLength;
  const double front = 0.5 * kLength;
  AddHull(&builder, index, {rear, front - kCabLength - 0.3, kBoxBottom, kBoxTop}, {textures.canvas, textures.rear},
          random.Uniform(0.6, 1.1));
  AddHull(&builder, index, {front - kCabLength, front, 0.5, kCabHeight}, {textures.cab, textures.cab},
          random.Uniform(0.4, 1.2));
  Material chassis = builder.WholeTexture(textures.chassis);
  chassis.body = index;
  for (const double side : {-1.0, 1.0}) {
    builder.Add({0.45 * side * kWidth, -kBoxBottom - 0.05, front - kCabLength}, {0.0, 0.0, rear - front + kCabLength},
                {0.0, kBoxBottom + 0.05, 0.0}, chassis, {side, 0.0, 0.0});
  }
}

}  // namespace evo::simulation
