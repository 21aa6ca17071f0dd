#include "evo/simulation/random.hpp"
#include "evo/simulation/world.hpp"
#include "simulation/scene_builder.hpp"
#include "simulation/textures.hpp"

namespace evo {

namespace {

constexpr std::uint64_t kStream = 0x736C69646572;
constexpr double kWall = 2.5;  // depths, m
constexpr double kMiddle = 1.5;
constexpr double kNear = 0.8;
const Eigen::Vector3d kTowardsCamera(0.0, 0.0, -1.0);

// A poster that faces the camera.
void Hang(SceneBuilder* builder, int texture, double x, double y, double width, double height, double depth) {
  builder->Add({x, y, depth}, {width, 0.0, 0.0}, {0.0, height, 0.0}, builder->Whole(texture), kTowardsCamera);
}

}  // namespace

Scene MakeSliderScene(std::uint64_t seed) {
  SceneBuilder builder;
  Random random(seed, kStream);
  builder.lighting().sky = 0.0;
  const int wall = builder.Add(PaintWall(random));
  Look look;
  look.texture = wall;
  look.texels = {12.0 * 170.0, 8.0 * 170.0};
  builder.Add({-6.0, -4.0, kWall + 0.01}, {12.0, 0.0, 0.0}, {0.0, 8.0, 0.0}, look, kTowardsCamera);
  for (int column = -2; column <= 2; ++column) {
    for (int row = -1; row <= 1; ++row) {
      const int picture = builder.Add(column % 2 == 0 ? PaintPicture(random) : PaintPoster(random));
      Hang(&builder, picture, 1.15 * column - 0.2 + random.Uniform(0.0, 0.1), 1.1 * row - 0.5, 1.0,
           random.Uniform(0.85, 1.0), kWall);
    }
  }
  for (const double x : {-1.0, 0.05, 1.1}) {
    Hang(&builder, builder.Add(PaintPoster(random)), x + random.Uniform(0.0, 0.2), random.Uniform(-0.5, 0.0), 0.5,
         random.Uniform(0.5, 0.8), kMiddle);
  }
  for (const double x : {-0.35, 0.45}) {
    Hang(&builder, builder.Add(PaintPoster(random)), x + random.Uniform(0.0, 0.1), random.Uniform(-0.1, 0.1), 0.25,
         random.Uniform(0.25, 0.4), kNear);
  }
  return builder.Take();
}

}  // namespace evo
