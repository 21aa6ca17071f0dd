#include <cmath>
#include <numbers>
#include <vector>

#include "evo/core/random.hpp"
#include "simulation/world/scene_builder.hpp"
#include "simulation/world/textures.hpp"
#include "simulation/world/world.hpp"

namespace evo::simulation {

namespace {

constexpr std::uint64_t kStream = 0x726F6F6D;    // "room"
const Eigen::Vector3d kHalfSize(2.0, 1.5, 2.5);  // m; the camera starts in the centre

/// Adds the wall (floor, ceiling) on one side (-1 or 1) of an axis.
void AddWall(SceneBuilder* builder, int axis, double side, int texture, double texels_per_m) {
  const int v_axis = axis == 1 ? 2 : 1;
  const int u_axis = 3 - axis - v_axis;
  Eigen::Vector3d origin = -kHalfSize;
  origin[axis] = side * kHalfSize[axis];
  Material material;
  material.texture = texture;
  material.texels = {2.0 * kHalfSize[u_axis] * texels_per_m, 2.0 * kHalfSize[v_axis] * texels_per_m};
  builder->Add(origin, 2.0 * kHalfSize[u_axis] * Eigen::Vector3d::Unit(u_axis),
               2.0 * kHalfSize[v_axis] * Eigen::Vector3d::Unit(v_axis), material, -side * Eigen::Vector3d::Unit(axis));
}

/// Adds two rows of posters to the four upright walls.
void AddPosters(SceneBuilder* builder, const std::vector<int>& posters, Random* random) {
  for (const int axis : {0, 2}) {
    const int u_axis = 2 - axis;
    for (const double side : {-1.0, 1.0}) {
      const double right = axis == 2 ? side : -side;  // to the right of the viewer along u
      for (const double top : {-1.45, -0.3}) {
        for (double u = -kHalfSize[u_axis] + 0.05; u + 1.1 < kHalfSize[u_axis];) {
          const double width = random->Uniform(0.6, 1.1);
          Eigen::Vector3d origin;
          origin[axis] = side * (kHalfSize[axis] - 0.01);
          origin[u_axis] = right > 0.0 ? u : u + width;
          origin.y() = top + random->Uniform(0.0, 0.1);
          builder->Add(origin, right * width * Eigen::Vector3d::Unit(u_axis),
                       random->Uniform(0.6, 1.0) * Eigen::Vector3d::UnitY(),
                       builder->WholeTexture(posters[random->Index(static_cast<int>(posters.size()))]),
                       -side * Eigen::Vector3d::Unit(axis));
          u += width + random->Uniform(0.02, 0.2);
        }
      }
    }
  }
}

/// Adds stacks of boxes along the walls, clear of the camera's path.
void AddBoxes(SceneBuilder* builder, const std::vector<int>& sides, Random* random) {
  constexpr int kStacks = 22;
  for (int i = 0; i < kStacks; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i + random->Uniform(-0.3, 0.3)) / kStacks;
    const double nearness = random->Uniform(0.9, 1.05);
    Eigen::Vector3d foot(1.6 * nearness * std::cos(angle), kHalfSize.y(), 2.05 * nearness * std::sin(angle));
    const int boxes = 2 + random->Index(5);
    for (int box = 0; box < boxes; ++box) {
      const Eigen::Vector3d size(random->Uniform(0.25, 0.5), random->Uniform(0.2, 0.45), random->Uniform(0.25, 0.5));
      const Eigen::Vector3d centre = foot - Eigen::Vector3d(0.0, 0.5 * size.y() + 0.001, 0.0);
      builder->AddBox(centre, size, random->Uniform(-0.5, 0.5), sides[random->Index(static_cast<int>(sides.size()))],
                      random->Uniform(0.7, 1.1));
      foot.y() -= size.y() + 0.001;
    }
  }
}

}  // namespace

Scene MakeRoom(std::uint64_t seed) {
  SceneBuilder builder;
  // Lamps on the ceiling with mostly diffuse light.
  builder.SetSun({Eigen::Vector3d(0.3, -0.8, -0.52).normalized(), 0.4});
  builder.lighting().sky = 0.0;
  Random random(seed, kStream);
  const int wall = builder.Add(PaintPlain(random, 0.55));
  const int carpet = builder.Add(PaintPicture(random));
  std::vector<int> posters;
  for (int i = 0; i < 5; ++i) posters.push_back(builder.Add(PaintPoster(random)));
  for (int i = 0; i < 3; ++i) posters.push_back(builder.Add(PaintPicture(random)));
  std::vector<int> boxes;
  for (int i = 0; i < 10; ++i) boxes.push_back(builder.Add(PaintBoxSide(random)));
  for (const int axis : {0, 1, 2}) {
    for (const double side : {-1.0, 1.0}) {
      const bool floor = axis == 1 && side > 0.0;
      AddWall(&builder, axis, side, floor ? carpet : wall, floor ? 250.0 : 200.0);
    }
  }
  AddPosters(&builder, posters, &random);
  AddBoxes(&builder, boxes, &random);
  return builder.Take();
}

}  // namespace evo::simulation
