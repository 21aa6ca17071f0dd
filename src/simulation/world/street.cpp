#include "simulation/world/street.hpp"

#include <cmath>
#include <memory>
#include <numbers>

namespace evo::simulation {

namespace {

constexpr std::uint64_t kSunStream = 0x73756E;

Sun DrawSun(std::uint64_t seed, bool night) {
  Sun sun;
  if (night) return sun;
  Random random(seed, kSunStream);
  const double azimuth = random.Uniform(0.0, 2.0 * std::numbers::pi);
  const double height = random.Uniform(0.6, 1.1);
  sun.towards = {std::cos(height) * std::cos(azimuth), -std::sin(height), std::cos(height) * std::sin(azimuth)};
  sun.share = 0.55;
  return sun;
}

Lighting StreetLighting(const StreetOptions& options) {
  Lighting lighting;
  if (options.light == "day") return lighting;
  lighting.ambient = options.night_ambient;
  lighting.sky = 0.003;
  lighting.head_lamps = options.head_lamps;
  lighting.flicker_hz = options.lamp_flicker_hz;
  return lighting;
}

}  // namespace

void Register(Parameters& parameters, StreetOptions& o) {
  parameters.Add("street.road_width_m", &o.road_width_m, 5.0, 20.0, "both lanes together (m)");
  parameters.Add("street.parking_width_m", &o.parking_width_m, 0.0, 5.0, "strip for parked cars on each side (m)");
  parameters.Add("street.pavement_width_m", &o.pavement_width_m, 1.0, 10.0, "on each side (m)");
  parameters.Add("street.house_share", &o.house_share, 0.0, 1.0, "of the way lined with houses");
  parameters.Add("street.trees_per_100_m", &o.trees_per_100_m, 0.0, 40.0, "both sides together");
  parameters.Add("street.poles_per_100_m", &o.poles_per_100_m, 0.0, 40.0, "street lamps, some with signs");
  parameters.Add("street.parked_cars_per_100_m", &o.parked_cars_per_100_m, 0.0, 36.0, "both sides together");
  parameters.Add("street.oncoming_cars_per_100_m", &o.oncoming_cars_per_100_m, 0.0, 12.0, "in the other lane");
  parameters.Add("street.oncoming_car_speed_m_s", &o.oncoming_car_speed_m_s, 0.0, 40.0, "m/s");
  parameters.Add("street.cars_ahead", &o.cars_ahead, 0, 20, "in our lane, driving as we do; motion.kind vehicle only");
  parameters.Add("street.light", &o.light, {"day", "night"}, "time of day");
  parameters.Add("street.night_ambient", &o.night_ambient, 0.0, 1.0, "light at night over that of the day");
  parameters.Add("street.head_lamps", &o.head_lamps, 0.0, 1000.0, "radiance of white 1 m ahead, at night");
  parameters.Add("street.lamp_flicker_hz", &o.lamp_flicker_hz, 0.0, 1000.0, "of the street lamps (Hz)");
}

Scene MakeStreet(const RoadLine& road, const StreetOptions& options, double camera_height_m, std::uint64_t seed,
                 const std::function<double(TimeNs)>& camera_distance_m) {
  const auto plan = std::make_shared<const StreetPlan>(road, options, camera_height_m);
  SceneBuilder builder;
  const bool night = options.light == "night";
  builder.SetSun(DrawSun(seed, night));
  builder.lighting() = StreetLighting(options);
  const StreetTask task{plan, options, builder, seed, night};
  AddRoadSurface(task);
  AddCrossings(task);
  AddFacades(task);
  AddTrees(task);
  AddPoles(task);
  AddParkedCars(task);
  AddOncomingCars(task);
  AddCarsAhead(task, camera_distance_m);
  return builder.Take();
}

}  // namespace evo::simulation
