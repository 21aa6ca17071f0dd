#include <Eigen/Geometry>
#include <algorithm>

#include "simulation/world/houses.hpp"
#include "simulation/world/street.hpp"

namespace evo::simulation {

namespace {

constexpr std::uint64_t kHouseStream = 0x686F757365;    // "house"
constexpr std::uint64_t kTextureStream = 0x66726F6E74;  // "front"

class FacadeRows {
 public:
  FacadeRows(const StreetContext& context, HouseFactory* factory)
      : plan_(context.plan), house_ratio_(context.options.house_share), builder_(context.builder), factory_(*factory) {}

  /// Alternates houses and open parts along one side of the road.
  void AddAlongRoad(int side, Random* random) {
    double open_deficit = 0.0;  // m of open road that are due: keeps the ratio even over the length
    for (double s = plan_.begin(); s < plan_.end() - 25.0;) {
      const int axes = 3 + random->Index(5);
      const double width = axes * HouseFactory::kAxisWidth;
      if (!plan_.IsClearOfJunctions(s, s + width, plan_.pavement() + 0.5)) {
        s += 1.0;
        continue;
      }
      open_deficit += (1.0 - house_ratio_) * width;
      if (house_ratio_ <= 0.0 || open_deficit > (0.5 + random->Uniform()) * width) {
        AddHedge(s, s + width, side, random);
        open_deficit -= width;
      } else {
        AddHouse(s, s + width, side, axes, random);
      }
      s += width;
    }
  }

  /// Lines both sides of a side road with houses and closes its end with one.
  void AddAlongArm(const StreetPlan::Junction& junction, const Eigen::Vector3d& arm, Random* random) {
    const Eigen::Vector3d across = arm.cross(junction.forward.cross(junction.right)).normalized();
    const double line = 0.5 * plan_.layout().width() + plan_.pavement();
    for (const double side : {-1.0, 1.0}) {
      for (double s = line + 0.5; s < kArmLength - 6.0;) {
        HouseFactory::Site site;
        site.axes = 3 + random->Index(4);
        const double width = site.axes * HouseFactory::kAxisWidth;
        site.inwards = side * across;
        site.corner = junction.centre + s * arm + side * (line + random->Uniform(0.0, 1.0)) * across;
        site.along = width * arm;
        BuildIfFree(site, random);
        s += width + (random->Chance(0.3) ? random->Uniform(1.0, 6.0) : 0.0);
      }
    }
    HouseFactory::Site end;
    end.axes = 7;
    end.along = end.axes * HouseFactory::kAxisWidth * across;
    end.inwards = arm;
    end.corner = junction.centre + kArmLength * arm - 0.5 * end.along;
    BuildIfFree(end, random);
  }

 private:
  void AddHouse(double from, double to, int side, int axes, Random* random) {
    HouseFactory::Site site;
    site.axes = axes;
    const double setback = random->Chance(0.5) ? 0.0 : random->Uniform(0.0, 2.5);
    const double lateral = plan_.house_line(side) + side * setback;
    Eigen::Vector3d a = plan_.PointAt(from, lateral, 0.0);
    Eigen::Vector3d b = plan_.PointAt(to, lateral, 0.0);
    site.along = b - a;
    site.inwards = side * plan_.Right(0.5 * (from + to));
    site.depth = random->Uniform(7.0, 11.0);
    site.corner = a;
    BuildIfFree(site, random);
  }

  /// Levels the house, with its foot in the ground at the higher end, and builds it if no road is in its way.
  void BuildIfFree(HouseFactory::Site site, Random* random) {
    site.corner.y() = std::max(site.corner.y(), site.corner.y() + site.along.y());
    site.along.y() = 0.0;
    site.inwards.y() = 0.0;
    site.inwards -= site.inwards.dot(site.along) / site.along.squaredNorm() * site.along;
    site.inwards.normalize();
    std::vector<Eigen::Vector3d> foot;
    for (double u = 0.0; u <= 1.0; u += 0.125) {
      for (double v = 0.0; v <= 1.0; v += 0.25) {
        foot.push_back(site.corner + u * site.along + v * site.depth * site.inwards);
      }
    }
    if (plan_.IsFree(foot)) factory_.Build(site, random);
  }

  /// A fence at the pavement, a hedge behind it and a row of trees in the distance.
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
    double texels_high;  ///< over the height
  };
  void AddScreen(double from, double to, double lateral, double height, const Screen& screen, int side,
                 Random* random) {
    Eigen::Vector3d a = plan_.PointAt(from, lateral, height);
    Eigen::Vector3d b = plan_.PointAt(to, lateral, height);
    if (!plan_.IsFree({a, b, 0.5 * (a + b)})) return;
    Material material;
    material.texture = screen.texture;
    material.texel_origin.x() = 256.0 * random->Uniform();
    material.texels = {(b - a).norm() * screen.texels_per_m, screen.texels_high};
    material.tone = random->Uniform(0.7, 1.1);
    builder_.Add(a, b - a, Eigen::Vector3d(0.0, height + 0.15, 0.0), material, -side * plan_.Right(from));
  }

  const StreetPlan& plan_;
  double house_ratio_;
  SceneBuilder& builder_;
  HouseFactory& factory_;
  int fence_ = -1;
  int hedge_ = -1;
};

}  // namespace

void AddFacades(const StreetContext& context) {
  Random paint(context.seed, kTextureStream);
  context.builder.SetContrast(context.options.facade_contrast);
  HouseFactory factory(&context.builder, context.night, context.options.wetness > 0.0, &paint);
  context.builder.SetContrast(1.0);
  FacadeRows rows(context, &factory);
  Random random(context.seed, kHouseStream);
  rows.AddAlongRoad(-1, &random);
  rows.AddAlongRoad(1, &random);
  for (const StreetPlan::Junction& junction : context.plan.junctions()) {
    for (const Eigen::Vector3d& arm : junction.arms) rows.AddAlongArm(junction, arm, &random);
  }
}

}  // namespace evo::simulation
