#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "simulation/world/street.hpp"

namespace evo::simulation {

namespace {

constexpr std::uint64_t kParkedStream = 0x7061726B;    // "park"
constexpr std::uint64_t kOncomingStream = 0x6D6F7665;  // "move"
constexpr std::uint64_t kAheadStream = 0x6168656164;   // "ahead"
// A compact car, m.
constexpr double kLength = 4.3;
constexpr double kWidth = 1.72;
constexpr double kHeight = 1.5;
constexpr double kBonnetHeight = 0.87;
constexpr double kTexelLength = kLength / 512.0;
constexpr double kTexelHeight = kHeight / 256.0;
constexpr double kHeadway = 1.3;      // s from car to car
constexpr double kStandingGap = 7.0;  // m from centre to centre at rest

/// Builds cars of a few shapes. The frame of a car lies on the ground below its centre: x right, y down, z forward.
class CarFactory {
 public:
  CarFactory(const StreetContext& context, Random* random) : builder_(context.builder), night_(context.night) {
    for (std::size_t i = 0; i < sides_.size(); ++i) sides_[i] = builder_.Add(PaintCarSide(kRears[i]));
    for (const bool front : {false, true}) ends_[front ? 1 : 0] = builder_.Add(PaintCarEnd(*random, front));
    paint_ = builder_.Add(PaintCarPaint(*random));
    glass_ = builder_.Add(PaintCarGlass(*random));
    shadow_ = builder_.Add(PaintCarShadow());
    if (context.options.wetness > 0.0) glow_ = builder_.Add(PaintGlow());
  }

  /// Adds a car to `body`.
  void Build(const geometry::SE3& T_body_car, int body, Random* random) {
    T_body_car_ = T_body_car;
    body_ = body;
    tone_ = random->Chance(0.5) ? random->Uniform(0.15, 0.5) : random->Uniform(0.6, 1.25);
    const int shape = random->Index(static_cast<int>(sides_.size()));
    const double front = 0.5 * kLength;
    for (const double side : {-0.5, 0.5}) {
      Add({side * kWidth, -kHeight, front}, {0.0, 0.0, -kLength}, {0.0, kHeight, 0.0}, sides_[shape], tone_,
          {side, 0.0, 0.0});
    }
    for (const double end : {-1.0, 1.0}) {
      Add({end * 0.5 * kWidth, -kBonnetHeight, end * front}, {-end * kWidth, 0.0, 0.0}, {0.0, 0.65, 0.0},
          ends_[end > 0.0 ? 1 : 0], tone_, {0.0, 0.0, end});
    }
    AddTop(kRears[shape]);
    Add({-0.55 * kWidth, -0.015, 0.52 * kLength}, {1.1 * kWidth, 0.0, 0.0}, {0.0, 0.0, -1.04 * kLength}, shadow_, 1.0,
        {0.0, -1.0, 0.0});
    if (night_ && body != 0) AddLights();
  }

 private:
  static constexpr std::array<double, 3> kRears = {425.0, 460.0, 500.0};  // see PaintCarSide

  void Add(const Eigen::Vector3d& origin, const Eigen::Vector3d& u, const Eigen::Vector3d& v, int texture, double tone,
           const Eigen::Vector3d& outwards, double emission = 0.0) {
    Material material = builder_.WholeTexture(texture, tone);
    material.body = body_;
    material.emission = emission;
    builder_.Add(T_body_car_ * origin, T_body_car_.rotation() * u, T_body_car_.rotation() * v, material,
                 T_body_car_.rotation() * outwards);
  }

  /// Adds bonnet, wind screen, roof, rear window and boot along the outline of the side.
  void AddTop(double rear) {
    const double roof_front = 130.0 + 104.0;
    const double roof_rear = rear - 104.0 / 2.2;
    const double roof = kHeight - 6.0 * kTexelHeight;
    struct Corner {
      double u, height;
      int texture;  // of the piece from here to the next
    };
    const std::array<Corner, 6> outline = {{{2.0, kBonnetHeight - 0.03, paint_},
                                            {130.0, kBonnetHeight, glass_},
                                            {roof_front, roof, paint_},
                                            {roof_rear, roof, glass_},
                                            {rear, kBonnetHeight, paint_},
                                            {510.0, kBonnetHeight - 0.02, paint_}}};
    for (std::size_t i = 0; i + 1 < outline.size(); ++i) {
      const auto point = [&](const Corner& corner) {
        return Eigen::Vector3d(-0.5 * kWidth, -corner.height, 0.5 * kLength - corner.u * kTexelLength);
      };
      const Eigen::Vector3d from = point(outline[i]);
      Add(from, {kWidth, 0.0, 0.0}, point(outline[i + 1]) - from, outline[i].texture,
          outline[i].texture == glass_ ? 1.0 : tone_, {0.0, -1.0, 0.0});
    }
  }

  void AddLights() {
    for (const double side : {-0.7, 0.46}) {
      const double x = side * 0.5 * kWidth;
      Add({x, -0.75, 0.5 * kLength + 0.01}, {0.22, 0.0, 0.0}, {0.0, 0.14, 0.0}, paint_, 1.0, {0.0, 0.0, 1.0}, 3.0);
      Add({x, -0.8, -0.5 * kLength - 0.01}, {0.22, 0.0, 0.0}, {0.0, 0.12, 0.0}, paint_, 1.0, {0.0, 0.0, -1.0}, 0.4);
      if (glow_ < 0) continue;
      // Their mirror images in the wet road, drawn out by its roughness.
      Add({x, 0.3, 0.5 * kLength + 0.01}, {0.25, 0.0, 0.0}, {0.0, 0.9, 0.0}, glow_, 1.0, {0.0, 0.0, 1.0}, 3.0);
      Add({x, 0.3, -0.5 * kLength - 0.01}, {0.25, 0.0, 0.0}, {0.0, 0.9, 0.0}, glow_, 1.0, {0.0, 0.0, -1.0}, 0.4);
    }
  }

  SceneBuilder& builder_;
  bool night_;
  std::array<int, 3> sides_;
  std::array<int, 2> ends_;  // rear, front
  int paint_ = 0;
  int glass_ = 0;
  int shadow_ = 0;
  int glow_ = -1;  ///< -1: the road is dry
  geometry::SE3 T_body_car_;
  int body_ = 0;
  double tone_ = 1.0;
};

/// T_world_car of a car on the road that faces along it or against it.
geometry::SE3 CarPose(const StreetPlan& plan, double distance, double lateral, bool oncoming) {
  const Eigen::Vector3d forward = (oncoming ? -1.0 : 1.0) * plan.Forward(distance);
  const Eigen::Vector3d right = (oncoming ? -1.0 : 1.0) * plan.Right(distance);
  Eigen::Matrix3d axes;
  axes << right, forward.cross(right), forward;
  return {Eigen::Quaterniond(axes), plan.PointAt(distance, lateral, 0.0)};
}

}  // namespace

void AddParkedCars(const StreetContext& context) {
  Random random(context.seed, kParkedStream);
  const StreetPlan& plan = context.plan;
  const double length = plan.end() - plan.begin();
  const int count = static_cast<int>(std::lround(context.options.parked_cars_per_100_m * length / 100.0));
  if (count == 0 || plan.layout().parking_m < kWidth + 0.2) return;
  CarFactory cars(context, &random);
  for (const int side : {-1, 1}) {
    const int on_side = side < 0 ? count / 2 : count - count / 2;
    // One car a slot, so that no two overlap.
    const double slot = std::max(length / std::max(1, on_side), kLength + 0.6);
    for (int i = 0; i < on_side && (i + 1) * slot <= length; ++i) {
      const double s = plan.begin() + i * slot + 0.5 * kLength + random.Uniform(0.3, slot - kLength);
      const double lateral = plan.kerb(side) - side * (0.5 * kWidth + 0.1 + random.Uniform(0.0, 0.1));
      if (!plan.IsClearOfJunctions(s - 0.5 * kLength, s + 0.5 * kLength, 4.0)) continue;
      cars.Build(CarPose(plan, s, lateral, side != plan.own_side()), 0, &random);
    }
  }
}

void AddOncomingCars(const StreetContext& context) {
  Random random(context.seed, kOncomingStream);
  const StreetOptions& options = context.options;
  const double from = context.plan.begin();
  const double length = context.plan.end() - from;
  const int count = static_cast<int>(std::lround(options.oncoming_cars_per_100_m * length / 100.0));
  if (count == 0) return;
  CarFactory cars(context, &random);
  const double spacing = length / count;
  const double first = random.Uniform(0.0, length);
  for (int i = 0; i < count; ++i) {
    const double start = first + (i + random.Uniform(-0.3, 0.3)) * spacing;
    Body body;
    body.T_world_body = [=, plan = context.shared_plan, speed = options.oncoming_car_speed_m_s](TimeNs t) {
      const double passed = std::fmod(start - speed * ToSeconds(t), length);
      return CarPose(*plan, from + (passed < 0.0 ? passed + length : passed), plan->other_lane(), true);
    };
    cars.Build(geometry::SE3(), context.builder.AddBody(std::move(body)), &random);
  }
}

void AddCarsAhead(const StreetContext& context, const std::function<double(TimeNs)>& camera_distance_m) {
  if (context.options.cars_ahead == 0 || !camera_distance_m) return;
  Random random(context.seed, kAheadStream);
  CarFactory cars(context, &random);
  for (int i = 1; i <= context.options.cars_ahead; ++i) {
    const double gap = kStandingGap * i + random.Uniform(0.0, 2.0);
    const TimeNs headway = FromSeconds(kHeadway * i);
    Body body;
    body.T_world_body = [=, plan = context.shared_plan](TimeNs t) {
      return CarPose(*plan, camera_distance_m(t + headway) + gap, plan->own_lane(), false);
    };
    cars.Build(geometry::SE3(), context.builder.AddBody(std::move(body)), &random);
  }
}

}  // namespace evo::simulation
