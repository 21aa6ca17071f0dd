#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulation/world/street.hpp"

namespace evo::simulation {

namespace {

constexpr std::uint64_t kWalkingStream = 0x77616C6B;   // "walk"
constexpr std::uint64_t kCrossingStream = 0x666F6F74;  // "foot"
constexpr double kHeight = 1.75;                       // m
constexpr double kWidth = 0.6;                         // m, with arms
constexpr double kHip = 0.85;                          // m above the ground
constexpr double kStride = 1.4;                        // m for two steps
constexpr double kSwing = 0.4;                         // rad of a leg to each side
// s before the camera arrives at which a pedestrian has left its lane: nobody walks in front of a car that comes.
constexpr double kMargin = 1.5;
constexpr double kMaxArrival = 3600.0;  // s
const Eigen::Vector3d kUp(0.0, -1.0, 0.0);

/// The pose of a pedestrian at a time, s: x right, y down, z forward, on the ground.
using Walk = std::function<geometry::SE3(double)>;

/// T_world_pedestrian at a place of the street; `heading` is that of the walk from the road's direction to its right.
geometry::SE3 PoseAt(const StreetPlan& plan, double distance, double lateral, double heading) {
  const bool on_road = lateral > plan.kerb(-1) && lateral < plan.kerb(1);
  return {Eigen::Quaterniond(Eigen::AngleAxisd(plan.Heading(distance) + heading, Eigen::Vector3d::UnitY())),
          plan.PointAt(distance, lateral, on_road ? 0.0 : kKerbHeight)};
}

/// Builds pedestrians of a few kinds.
class PedestrianFactory {
 public:
  PedestrianFactory(SceneBuilder* builder, Random* random) : builder_(*builder) {
    for (int& torso : torsos_) torso = builder_.Add(PaintTorso(*random));
    leg_ = builder_.Add(PaintPlain(*random, 0.35));
  }

  /// Adds a pedestrian whose legs swing as far as `walked_m` says.
  void Build(const Walk& walk, const std::function<double(double)>& walked_m, Random* random) {
    const int body = AddBody(walk);
    const double tone = random->Uniform(0.5, 1.2);
    const double dark = random->Uniform(0.15, 1.0);
    AddCross(body, torsos_[random->Index(2)], kHeight, kHip - 0.05, kWidth, 0.0, tone);
    for (const double side : {-1.0, 1.0}) {
      const int leg = AddBody([=](double t) {
        const double swing = kSwing * side * std::sin(2.0 * std::numbers::pi * walked_m(t) / kStride);
        return walk(t) *
               geometry::SE3(Eigen::Quaterniond(Eigen::AngleAxisd(swing, Eigen::Vector3d::UnitX())), kHip * kUp);
      });
      AddCross(leg, leg_, 0.0, -kHip, 0.17, 0.1 * side, dark);
    }
  }

 private:
  int AddBody(const Walk& walk) {
    return builder_.AddBody({[walk](TimeNs t) { return walk(ToSeconds(t)); }});
  }

  /// Adds two crossed upright planes between two heights.
  void AddCross(int body, int texture, double top, double bottom, double width, double lateral, double tone) {
    Material material = builder_.WholeTexture(texture, tone);
    material.body = body;
    const Eigen::Vector3d centre = top * kUp + Eigen::Vector3d(lateral, 0.0, 0.0);
    for (const Eigen::Vector3d& across : {Eigen::Vector3d::UnitX().eval(), Eigen::Vector3d::UnitZ().eval()}) {
      builder_.Add(centre - 0.5 * width * across, width * across, (bottom - top) * kUp, material,
                   across.cross(Eigen::Vector3d::UnitY()));
    }
  }

  SceneBuilder& builder_;
  int torsos_[2] = {0, 0};
  int leg_ = 0;
};

/// The time (s) at which the camera has covered `distance`, at most kMaxArrival.
double ArrivalTime(const std::function<double(TimeNs)>& camera_distance_m, double distance) {
  double before = 0.0;
  double after = kMaxArrival;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (before + after);
    (camera_distance_m(FromSeconds(middle)) < distance ? before : after) = middle;
  }
  return after;
}

}  // namespace

void AddPedestrians(const StreetContext& context) {
  const StreetPlan& plan = context.plan;
  const double length = plan.end() - plan.begin();
  const int count = static_cast<int>(std::lround(context.options.pedestrians_per_100_m * length / 100.0));
  if (count == 0) return;
  Random random(context.seed, kWalkingStream);
  PedestrianFactory pedestrians(&context.builder, &random);
  for (int i = 0; i < count; ++i) {
    const double start = random.Uniform(0.0, length);
    const int side = random.Chance(0.5) ? 1 : -1;
    const double speed = (random.Chance(0.5) ? 1.0 : -1.0) * random.Uniform(0.9, 1.6);
    const double lateral = plan.kerb(side) + side * random.Uniform(0.3, 0.9) * plan.pavement();
    const Walk walk = [=, plan = context.shared_plan](double t) {
      const double passed = std::fmod(start + speed * t, length);
      return PoseAt(*plan, plan->begin() + (passed < 0.0 ? passed + length : passed), lateral,
                    speed > 0.0 ? 0.0 : std::numbers::pi);
    };
    pedestrians.Build(
        walk, [=](double t) { return std::abs(speed) * t; }, &random);
  }
}

void AddCrossingPedestrians(const StreetContext& context, const std::function<double(TimeNs)>& camera_distance_m) {
  if (context.options.crossing_pedestrians_per_100_m <= 0.0 || !camera_distance_m) return;
  Random random(context.seed, kCrossingStream);
  const StreetPlan& plan = context.plan;
  PedestrianFactory pedestrians(&context.builder, &random);
  const double spacing = 100.0 / context.options.crossing_pedestrians_per_100_m;
  for (double s = random.Uniform(8.0, 8.0 + spacing); s < plan.end() - 20.0; s += spacing * random.Uniform(0.6, 1.4)) {
    const int side = random.Chance(0.5) ? 1 : -1;
    const double speed = random.Uniform(1.1, 1.7);
    const double from = plan.kerb(side) + side * 1.0;
    const double to = plan.kerb(-side) - side * 1.0;
    const double lane_end = plan.own_lane() - side * 0.25 * plan.layout().lanes_m;
    const double leaves_lane = ArrivalTime(camera_distance_m, s) - kMargin - random.Uniform(0.0, 1.5);
    const double start = leaves_lane - std::abs(lane_end - from) / speed;
    const auto walked = [=](double t) { return std::clamp(speed * (t - start), 0.0, std::abs(to - from)); };
    const Walk walk = [=, plan = context.shared_plan](double t) {
      return PoseAt(*plan, s, from - side * walked(t), -side * 0.5 * std::numbers::pi);
    };
    pedestrians.Build(walk, walked, &random);
  }
}

}  // namespace evo::simulation
