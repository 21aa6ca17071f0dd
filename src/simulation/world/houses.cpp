#include "simulation/world/houses.hpp"

#include <Eigen/Geometry>

#include "simulation/world/textures.hpp"

namespace evo::simulation {

namespace {

constexpr double kFloorHeight = 3.1;  // m
const Eigen::Vector3d kUp(0.0, -1.0, 0.0);

/// `count` textures of a kind.
template <class Paint>
std::vector<int> PaintMany(SceneBuilder* builder, Random* random, int count, Paint paint) {
  std::vector<int> textures;
  for (int i = 0; i < count; ++i) textures.push_back(builder->Add(paint(*random)));
  return textures;
}

int DrawOne(const std::vector<int>& textures, Random* random) {
  return textures[random->Index(static_cast<int>(textures.size()))];
}

}  // namespace

HouseFactory::HouseFactory(SceneBuilder* builder, bool night, bool wet, Random* random)
    : builder_(*builder),
      night_(night),
      wet_(wet),
      uppers_(PaintMany(builder, random, 9, PaintUpperFloors)),
      grounds_(PaintMany(builder, random, 6, PaintGroundFloor)),
      walls_(PaintMany(builder, random, 3, PaintWall)),
      signs_(PaintMany(builder, random, 6, PaintShopSign)),
      roof_(builder->Add(PaintRoof(*random))),
      gable_(builder->Add(PaintGable(*random))),
      lit_window_(builder->Add(PaintLitWindow(*random))),
      plain_(builder->Add(PaintPlain(*random, 0.6))) {}

void HouseFactory::Build(Site site, Random* random) {
  // The facade runs from left to right as seen from the road, so that its lettering is not mirrored.
  if (site.along.dot(kUp.cross(site.inwards)) > 0.0) {
    site.corner += site.along;
    site.along = -site.along;
  }
  const int floors = 1 + random->Index(4);
  const double tone = random->Uniform(0.75, 1.1);
  const double height = kFloorHeight * (floors + 1);
  AddFacade(site, DrawOne(uppers_, random), DrawOne(grounds_, random), floors, tone, random);
  Material side;
  side.texture = DrawOne(walls_, random);
  side.texel_origin = {512.0 * random->Uniform(), 512.0 * random->Uniform()};
  side.texels = {site.depth * 40.0, height * 40.0};
  side.tone = tone;
  const Eigen::Vector3d top = site.corner + height * kUp;
  builder_.Add(top, site.depth * site.inwards, -height * kUp, side, -site.along);
  builder_.Add(top + site.along, site.depth * site.inwards, -height * kUp, side, site.along);
  AddEaves(site, height, tone, random);
  AddSigns(site, random);
  if (night_) AddLitWindows(site, floors, random);
}

void HouseFactory::AddFacade(const Site& site, int upper, int ground, int floors, double tone, Random* random) {
  Material material;
  material.tone = tone;
  material.texture = ground;
  material.texel_origin = {kFacadeCell * static_cast<double>(random->Index(kFacadeAxes)), 0.0};
  material.texels = {static_cast<double>(site.axes * kFacadeCell), kFacadeCell};
  const Eigen::Vector3d outwards = -site.inwards;
  builder_.Add(site.corner + kFloorHeight * kUp, site.along, -kFloorHeight * kUp, material, outwards);
  material.texture = upper;
  material.texel_origin = {kFacadeCell * static_cast<double>(random->Index(kFacadeAxes)),
                           kFacadeCell * static_cast<double>(random->Index(kFacadeFloors))};
  material.texels.y() = floors * kFacadeCell;
  const double height = floors * kFloorHeight;
  const Eigen::Vector3d top = site.corner + (kFloorHeight + height) * kUp;
  builder_.Add(top, site.along, -height * kUp, material, outwards);
  if (site.axes < 4 || !random->Chance(0.4)) return;
  // An oriel of one axis, with the same part of the texture on its front.
  const double axis = site.along.norm() / site.axes;
  const Eigen::Vector3d along = site.along.normalized();
  const int at = 1 + random->Index(site.axes - 2);
  material.texel_origin.x() += at * kFacadeCell;
  material.texels.x() = kFacadeCell;
  const Eigen::Vector3d out = 0.7 * outwards;
  const Eigen::Vector3d corner = top + at * axis * along;
  builder_.Add(corner + out, axis * along, -height * kUp, material, outwards);
  material.texels = {16.0, floors * static_cast<double>(kFacadeCell)};
  builder_.Add(corner, out, -height * kUp, material, -along);
  builder_.Add(corner + axis * along, out, -height * kUp, material, along);
  builder_.Add(corner - height * kUp, out, axis * along, builder_.WholeTexture(plain_, 0.5 * tone), -kUp);
}

void HouseFactory::AddEaves(const Site& site, double height, double tone, Random* random) {
  const Eigen::Vector3d top = site.corner + height * kUp;
  const Eigen::Vector3d out = -random->Uniform(0.2, 0.5) * site.inwards;
  Material material = builder_.WholeTexture(plain_, random->Uniform(0.5, 1.1) * tone);
  const Eigen::Vector3d edge = -random->Uniform(0.15, 0.45) * kUp;
  builder_.Add(top + out, site.along, edge, material, out);
  material.tone *= 0.5;  // shadow under the eaves
  builder_.Add(top + edge, site.along, out, material, -kUp);
  if (!random->Chance(0.6)) return;
  const Eigen::Vector3d gable = 0.5 * site.depth * random->Uniform(0.5, 0.9) * kUp;
  for (const double end : {0.0, 1.0}) {
    builder_.Add(top + end * site.along + gable, site.depth * site.inwards, -gable, builder_.WholeTexture(gable_, tone),
                 (2.0 * end - 1.0) * site.along);
  }
  const Eigen::Vector3d slope = 0.5 * site.depth * site.inwards + gable - out;
  material.texture = roof_;
  material.texels = {site.along.norm() * 32.0, -slope.norm() * 32.0};
  material.tone = tone;
  builder_.Add(top + out, site.along, slope, material, kUp);
}

void HouseFactory::AddSigns(const Site& site, Random* random) {
  const double width = site.along.norm();
  const Eigen::Vector3d along = site.along / width;
  if (random->Chance(0.5)) {  // across the pavement
    const Eigen::Vector3d from = site.corner + random->Uniform(0.1, 0.9) * site.along + 3.9 * kUp;
    const Eigen::Vector3d out = -random->Uniform(0.6, 1.0) * site.inwards;
    const int sign = DrawOne(signs_, random);
    for (const double face : {-1.0, 1.0}) {
      const Eigen::Vector3d foot = from + (face > 0.0 ? out : Eigen::Vector3d::Zero()) + 0.02 * face * along;
      builder_.Add(foot - 0.1 * site.inwards, -face * out, -0.7 * kUp, builder_.WholeTexture(sign), face * along);
    }
  }
  if (random->Chance(0.35)) {  // an awning
    const double at = random->Uniform(0.0, 0.6) * width;
    const Eigen::Vector3d from = site.corner + at * along + 2.9 * kUp;
    builder_.Add(from, 0.35 * width * along, -1.1 * site.inwards - 0.5 * kUp,
                 builder_.WholeTexture(DrawOne(signs_, random), random->Uniform(0.6, 1.1)), kUp);
  }
}

void HouseFactory::AddLitWindows(const Site& site, int floors, Random* random) {
  const Eigen::Vector3d cell = site.along / site.axes;
  for (int floor = 0; floor <= floors; ++floor) {
    for (int axis = 0; axis < site.axes; ++axis) {
      if (!random->Chance(0.12)) continue;
      Material material = builder_.WholeTexture(lit_window_);
      material.emission = random->Uniform(0.03, 0.25);
      const Eigen::Vector3d centre =
          site.corner + (axis + 0.5) * cell + (floor + 0.5) * kFloorHeight * kUp - 0.03 * site.inwards;
      builder_.Add(centre - 0.17 * cell + 0.65 * kUp, 0.34 * cell, -1.3 * kUp, material, -site.inwards);
      if (!wet_) continue;
      const Eigen::Vector3d mirrored = centre - 2.0 * (floor + 0.5) * kFloorHeight * kUp;
      builder_.Add(mirrored - 0.17 * cell - 0.65 * kUp, 0.34 * cell, 1.3 * kUp, material, -site.inwards);
    }
  }
}

}  // namespace evo::simulation
