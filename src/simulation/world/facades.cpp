#include <algorithm>
#include <cmath>

#include "simulation/world/street.hpp"

namespace evo::simulation {

namespace {

constexpr std::uint64_t kHouseStream = 0x686F757365;
constexpr std::uint64_t kTextureStream = 0x66726F6E74;
constexpr double kFloorHeight = 3.1;
const Eigen::Vector3d kUp(0.0, -1.0, 0.0);

// `count` textures of a kind.
template <class Paint>
std::vector<int> PaintMany(SceneBuilder* builder, Random* random, int count, Paint paint) {
  std::vector<int> textures;
  for (int i = 0; i < count; ++i) textures.push_back(builder->Add(paint(*random)));
  return textures;
}

int OneOf(const std::vector<int>& textures, Random* random) {
  return textures[random->Index(static_cast<int>(textures.size()))];
}

}  // namespace

HouseFactory::HouseFactory(SceneBuilder* builder, bool night, Random* random)
    : builder_(*builder),
      night_(night),
      uppers_(PaintMany(builder, random, 9, PaintUpperFloors)),
      grounds_(PaintMany(builder, random, 6, PaintGroundFloor)),
      walls_(PaintMany(builder, random, 3, PaintWall)),
      signs_(PaintMany(builder, random, 6, PaintShopSign)),
      roof_(builder->Add(PaintRoof(*random))),
      gable_(builder->Add(PaintGable(*random))),
      lit_window_(builder->Add(PaintLitWindow(*random))),
      plain_(builder->Add(PaintPlain(*random, 0.6))) {}

void HouseFactory::Build(Place place, Random* random) {
  // The front runs from left to right as seen from the road, so that its lettering can be read.
  if (place.along.dot(kUp.cross(place.inwards)) > 0.0) {
    place.corner += place.along;
    place.along = -place.along;
  }
  const int floors = 1 + random->Index(4);
  const double tone = random->Uniform(0.75, 1.1);
  const double height = kFloorHeight * (floors + 1);
  AddFront(place, OneOf(uppers_, random), OneOf(grounds_, random), floors, tone, random);
  Look side;
  side.texture = OneOf(walls_, random);
  side.texel_origin = {512.0 * random->Uniform(), 512.0 * random->Uniform()};
  side.texels = {place.depth * 40.0, height * 40.0};
  side.tone = tone;
  const Eigen::Vector3d top = place.corner + height * kUp;
  builder_.Add(top, place.depth * place.inwards, -height * kUp, side, -place.along);
  builder_.Add(top + place.along, place.depth * place.inwards, -height * kUp, side, place.along);
  AddEaves(place, height, tone, random);
  AddSigns(place, random);
  if (night_) AddLitWindows(place, floors, random);
}

void HouseFactory::AddFront(const Place& place, int upper, int ground, int floors, double tone, Random* random) {
  Look look;
  look.tone = tone;
  look.texture = ground;
  look.texel_origin = {kFacadeCell * static_cast<double>(random->Index(kFacadeAxes)), 0.0};
  look.texels = {static_cast<double>(place.axes * kFacadeCell), kFacadeCell};
  const Eigen::Vector3d outwards = -place.inwards;
  builder_.Add(place.corner + kFloorHeight * kUp, place.along, -kFloorHeight * kUp, look, outwards);
  look.texture = upper;
  look.texel_origin = {kFacadeCell * static_cast<double>(random->Index(kFacadeAxes)),
                       kFacadeCell * static_cast<double>(random->Index(kFacadeFloors))};
  look.texels.y() = floors * kFacadeCell;
  const double height = floors * kFloorHeight;
  const Eigen::Vector3d top = place.corner + (kFloorHeight + height) * kUp;
  builder_.Add(top, place.along, -height * kUp, look, outwards);
  if (place.axes < 4 || !random->Chance(0.4)) return;
  // An oriel, one axis wide: its front is part of the same picture.
  const double axis = place.along.norm() / place.axes;
  const Eigen::Vector3d along = place.along.normalized();
  const int at = 1 + random->Index(place.axes - 2);
  look.texel_origin.x() += at * kFacadeCell;
  look.texels.x() = kFacadeCell;
  const Eigen::Vector3d out = 0.7 * outwards;
  const Eigen::Vector3d corner = top + at * axis * along;
  builder_.Add(corner + out, axis * along, -height * kUp, look, outwards);
  look.texels = {16.0, floors * static_cast<double>(kFacadeCell)};
  builder_.Add(corner, out, -height * kUp, look, -along);
  builder_.Add(corner + axis * along, out, -height * kUp, look, along);
  builder_.Add(corner - height * kUp, out, axis * along, builder_.Whole(plain_, 0.5 * tone), -kUp);
}

void HouseFactory::AddEaves(const Place& place, double height, double tone, Random* random) {
  const Eigen::Vector3d top = place.corner + height * kUp;
  const Eigen::Vector3d out = -random->Uniform(0.2, 0.5) * place.inwards;
  Look look = builder_.Whole(plain_, random->Uniform(0.5, 1.1) * tone);
  const Eigen::Vector3d edge = -random->Uniform(0.15, 0.45) * kUp;
  builder_.Add(top + out, place.along, edge, look, out);
  look.tone *= 0.5;  // in its own shadow
  builder_.Add(top + edge, place.along, out, look, -kUp);
  if (!random->Chance(0.6)) return;
  const Eigen::Vector3d gable = 0.5 * place.depth * random->Uniform(0.5, 0.9) * kUp;
  for (const double end : {0.0, 1.0}) {
    builder_.Add(top + end * place.along + gable, place.depth * place.inwards, -gable, builder_.Whole(gable_, tone),
                 (2.0 * end - 1.0) * place.along);
  }
  const Eigen::Vector3d slope = 0.5 * place.depth * place.inwards + gable - out;
  look.texture = roof_;
  look.texels = {place.along.norm() * 32.0, -slope.norm() * 32.0};
  look.tone = tone;
  builder_.Add(top + out, place.along, slope, look, kUp);
}

void HouseFactory::AddSigns(const Place& place, Random* random) {
  const double width = place.along.norm();
  const Eigen::Vector3d along = place.along / width;
  if (random->Chance(0.5)) {  // across the pavement
    const Eigen::Vector3d from = place.corner + random->Uniform(0.1, 0.9) * place.along + 3.9 * kUp;
    const Eigen::Vector3d out = -random->Uniform(0.6, 1.0) * place.inwards;
    const int sign = OneOf(signs_, random);
    // One face a side.
    for (const double face : {-1.0, 1.0}) {
      const Eigen::Vector3d foot = from + (face > 0.0 ? out : Eigen::Vector3d::Zero()) + 0.02 * face * along;
      builder_.Add(foot - 0.1 * place.inwards, -face * out, -0.7 * kUp, builder_.Whole(sign), face * along);
    }
  }
  if (random->Chance(0.35)) {  // an awning
    const double at = random->Uniform(0.0, 0.6) * width;
    const Eigen::Vector3d from = place.corner + at * along + 2.9 * kUp;
    builder_.Add(from, 0.35 * width * along, -1.1 * place.inwards - 0.5 * kUp,
                 builder_.Whole(OneOf(signs_, random), random->Uniform(0.6, 1.1)), kUp);
  }
}

void HouseFactory::AddLitWindows(const Place& place, int floors, Random* random) {
  const Eigen::Vector3d cell = place.along / place.axes;
  for (int floor = 0; floor <= floors; ++floor) {
    for (int axis = 0; axis < place.axes; ++axis) {
      if (!random->Chance(0.12)) continue;
      Look look = builder_.Whole(lit_window_);
      look.emission = random->Uniform(0.03, 0.25);
      const Eigen::Vector3d centre =
          place.corner + (axis + 0.5) * cell + (floor + 0.5) * kFloorHeight * kUp - 0.03 * place.inwards;
      builder_.Add(centre - 0.17 * cell + 0.65 * kUp, 0.34 * cell, -1.3 * kUp, look, -place.inwards);
    }
  }
}

namespace {

class FacadeRows {
 public:
  FacadeRows(const StreetTask& task, HouseFactory* factory)
      : plan_(task.plan), share_(task.options.house_share), builder_(task.builder), factory_(*factory) {}

  // Houses and open stretches in turn along one side of the road.
  void LineRoad(int side, Random* random) {
    double open_owed = 0.0;  // keeps the share even over the length
    for (double s = plan_.begin(); s < plan_.end() - 25.0;) {
      const int axes = 3 + random->Index(5);
      const double width = axes * HouseFactory::kAxisWidth;
      if (!plan_.IsClearOfCrossings(s, s + width, plan_.pavement() + 0.5)) {
        s += 1.0;
        continue;
      }
      open_owed += (1.0 - share_) * width;
      if (share_ <= 0.0 || open_owed > (0.5 + random->Uniform()) * width) {
        AddHedge(s, s + width, side, random);
        open_owed -= width;
      } else {
        AddHouse(s, s + width, side, axes, random);
      }
      s += width;
    }
  }

  void LineArm(const StreetPlan::Crossing& crossing, const Eigen::Vector3d& arm, Random* random) {
    const Eigen::Vector3d across = arm.cross(crossing.forward.cross(crossing.right)).normalized();
    const double line = 0.5 * plan_.layout().width() + plan_.pavement();
    for (const double side : {-1.0, 1.0}) {
      for (double s = line + 0.5; s < kArmLength - 6.0;) {
        HouseFactory::Place place;
        place.axes = 3 + random->Index(4);
        const double width = place.axes * HouseFactory::kAxisWidth;
        place.inwards = side * across;
        place.corner = crossing.centre + s * arm + side * (line + random->Uniform(0.0, 1.0)) * across;
        place.along = width * arm;
        BuildIfFree(place, random);
        s += width + (random->Chance(0.3) ? random->Uniform(1.0, 6.0) : 0.0);
      }
    }
    HouseFactory::Place end;
    end.axes = 7;
    end.along = end.axes * HouseFactory::kAxisWidth * across;
    end.inwards = arm;
    end.corner = crossing.centre + kArmLength * arm - 0.5 * end.along;
    BuildIfFree(end, random);
  }

 private:
  void AddHouse(double from, double to, int side, int axes, Random* random) {
    HouseFactory::Place place;
    place.axes = axes;
    const double setback = random->Chance(0.5) ? 0.0 : random->Uniform(0.0, 2.5);
    const double lateral = plan_.house_line(side) + side * setback;
    Eigen::Vector3d a = plan_.At(from, lateral, 0.0);
    Eigen::Vector3d b = plan_.At(to, lateral, 0.0);
    place.along = b - a;
    place.inwards = side * plan_.Right(0.5 * (from + to));
    place.depth = random->Uniform(7.0, 11.0);
    place.corner = a;
    BuildIfFree(place, random);
  }

  // Stands level, its foot in the ground at the lower end.
  void BuildIfFree(HouseFactory::Place place, Random* random) {
    place.corner.y() = std::max(place.corner.y(), place.corner.y() + place.along.y());
    place.along.y() = 0.0;
    place.inwards.y() = 0.0;
    place.inwards -= place.inwards.dot(place.along) / place.along.squaredNorm() * place.along;
    place.inwards.normalize();
    std::vector<Eigen::Vector3d> foot;
    for (double u = 0.0; u <= 1.0; u += 0.125) {
      for (double v = 0.0; v <= 1.0; v += 0.25) {
        foot.push_back(place.corner + u * place.along + v * place.depth * place.inwards);
      }
    }
    if (plan_.IsFree(foot)) factory_.Build(place, random);
  }

  // A fence at the pavement, bushes behind and a row of trees far off.
  void AddHedge(double from, double to, int side, Random* random) {
    if (fence_ < 0) {
      fence_ = builder_.Add(PaintFence(*random));
      hedge_ = builder_.Add(PaintHedge(*random));
    }
    AddScreen(from, to, plan_.house_line(side) + side * 0.2, 1.0, {fence_, 256.0 / 4.0, 64.0}, side, random);
    AddScreen(from, to, plan_.house_line(side) + side * random->Uniform(2.0, 5.0), random->Uniform(1.2, 2.2),
              {hedge_, 256.0 / 2.5, 256.0}, side, random);
    AddScreen(from - 5.0, to + 5.0, plan_.house_line(side) + side * random->Uniform(18.0, 26.0),
              random->Uniform(4.0, 8.0), {hedge_, 256.0 / 7.0, 256.0}, side, random);
  }

  struct Screen {
    int texture;
    double texels_per_m;
    double texels_high;
  };
  void AddScreen(double from, double to, double lateral, double height, const Screen& screen, int side,
                 Random* random) {
    Eigen::Vector3d a = plan_.At(from, lateral, height);
    Eigen::Vector3d b = plan_.At(to, lateral, height);
    if (!plan_.IsFree({a, b, 0.5 * (a + b)})) return;
    Look look;
    look.texture = screen.texture;
    look.texel_origin.x() = 256.0 * random->Uniform();
    look.texels = {(b - a).norm() * screen.texels_per_m, screen.texels_high};
    look.tone = random->Uniform(0.7, 1.1);
    builder_.Add(a, b - a, Eigen::Vector3d(0.0, height + 0.15, 0.0), look, -side * plan_.Right(from));
  }

  const StreetPlan& plan_;
  double share_;
  SceneBuilder& builder_;
  HouseFactory& factory_;
  int fence_ = -1;
  int hedge_ = -1;
};

}  // namespace

void AddFacades(const StreetTask& task) {
  Random paint(task.seed, kTextureStream);
  HouseFactory factory(&task.builder, task.night, &paint);
  FacadeRows rows(task, &factory);
  Random random(task.seed, kHouseStream);
  rows.LineRoad(-1, &random);
  rows.LineRoad(1, &random);
  for (const StreetPlan::Crossing& crossing : task.plan.crossings()) {
    for (const Eigen::Vector3d& arm : crossing.arms) rows.LineArm(crossing, arm, &random);
  }
}

}  // namespace evo::simulation
