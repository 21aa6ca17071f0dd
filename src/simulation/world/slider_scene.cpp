#include "evo/core/random.hpp"
#include "simulation/world/scene_builder.hpp"
#include "simulation/world/textures.hpp"
#include "simulation/world/world.hpp"

namespace evo::simulation {

namespace {

constexpr std::uint64_t kStream = 0x736C69646572;  // "slider"
constexpr double kWallDepth = 1.4;                 // m
constexpr double kTable = 0.2;                     // m below the camera
constexpr double kLeft = -0.9;                     // m: the furnished part, for a motion of 1 m to the right
constexpr double kRight = 1.9;
const Eigen::Vector3d kTowardsCamera(0.0, 0.0, -1.0);

void AddRoom(SceneBuilder* builder, Random* random) {
  const auto plain = [&](double reflectance) {
    Material material = builder->WholeTexture(builder->Add(PaintPlain(*random, reflectance)));
    material.texels = {640.0, 640.0};
    return material;
  };
  builder->Add({-6.0, -4.0, kWallDepth}, {12.0, 0.0, 0.0}, {0.0, 8.0, 0.0}, plain(0.65), kTowardsCamera);
  builder->Add({-6.0, kTable, 0.1}, {12.0, 0.0, 0.0}, {0.0, 0.0, kWallDepth}, plain(0.45), -Eigen::Vector3d::UnitY());
}

/// Adds posters to the wall, with gaps between them.
void AddPosters(SceneBuilder* builder, Random* random) {
  for (double x = kLeft; x < kRight; x += 0.55 + random->Uniform(0.1, 0.3)) {
    const double size = random->Uniform(0.4, 0.55);
    const int picture = builder->Add(random->Chance(0.2) ? PaintPicture(*random) : PaintPlacard(*random));
    builder->Add({x, random->Uniform(-0.75, -0.5), kWallDepth - 0.01}, {size, 0.0, 0.0}, {0.0, size, 0.0},
                 builder->WholeTexture(picture), kTowardsCamera);
  }
}

/// Adds a row of upright boxes to the table: books at the back, packets in front.
void AddRow(SceneBuilder* builder, double depth, double max_height, double gap, Random* random) {
  for (double x = kLeft + random->Uniform(0.0, gap); x < kRight;) {
    const double height = max_height * random->Uniform(0.5, 1.0);
    const Eigen::Vector3d size(height * random->Uniform(0.4, 0.8), height, height * random->Uniform(0.3, 0.6));
    const Eigen::Vector3d centre(x, kTable - 0.5 * height, depth + random->Uniform(-0.05, 0.05));
    builder->AddBox(centre, size, random->Uniform(-0.6, 0.6), builder->Add(PaintBoxSide(*random)),
                    random->Uniform(0.6, 1.1));
    x += size.x() + gap * random->Uniform(0.5, 1.5);
  }
}

}  // namespace

Scene MakeSliderScene(std::uint64_t seed) {
  SceneBuilder builder;
  Random random(seed, kStream);
  builder.SetSun({Eigen::Vector3d(-0.4, -0.6, -0.69).normalized(), 0.5});
  builder.lighting().sky = 0.0;
  AddRoom(&builder, &random);
  AddPosters(&builder, &random);
  AddRow(&builder, 1.0, 0.4, 0.2, &random);
  AddRow(&builder, 0.7, 0.22, 0.25, &random);
  AddRow(&builder, 0.42, 0.11, 0.3, &random);
  return builder.Take();
}

}  // namespace evo::simulation
