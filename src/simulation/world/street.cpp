#include "simulation/world/street.hpp"

#include <cmath>
#include <memory>
#include <numbers>

namespace evo::simulation {

namespace {

constexpr std::uint64_t kSunStream = 0x73756E;  // "sun"
constexpr double kSunRatio = 0.55;              // of sunlight, by day
constexpr double kNightSky = 0.003;             // radiance: just above the sensor's dark current

Sun DrawSun(std::uint64_t seed, bool day) {
  Sun sun;
  if (!day) return sun;
  Random random(seed, kSunStream);
  const double azimuth = random.Uniform(0.0, 2.0 * std::numbers::pi);
  const double elevation = random.Uniform(0.6, 1.1);
  sun.towards = {std::cos(elevation) * std::cos(azimuth), -std::sin(elevation),
                 std::cos(elevation) * std::sin(azimuth)};
  sun.ratio = kSunRatio;
  return sun;
}

Lighting StreetLighting(const StreetOptions& options) {
  Lighting lighting;
  if (options.light == "day") return lighting;
  const bool dusk = options.light == "dusk";
  lighting.ambient = dusk ? options.dusk_ambient : options.night_ambient;
  lighting.sky = dusk ? lighting.sky * options.dusk_ambient : kNightSky;
  lighting.head_lamps = options.head_lamps;
  lighting.flicker_hz = options.lamp_flicker_hz;
  lighting.flicker_depth = options.lamp_flicker_depth;
  return lighting;
}

}  // namespace

Scene MakeStreet(const ReferenceLine& road, const StreetOptions& options, double camera_height_m, std::uint64_t seed,
                 const std::function<double(TimeNs)>& camera_distance_m) {
  const auto plan = std::make_shared<const StreetPlan>(road, options, camera_height_m);
  SceneBuilder builder;
  const bool night = options.light != "day";
  builder.SetSun(DrawSun(seed, !night));
  builder.lighting() = StreetLighting(options);
  const StreetContext context{plan, options, builder, seed, night};
  AddRoadSurface(context);
  AddJunctions(context);
  AddFacades(context);
  AddTrees(context);
  AddPoles(context);
  AddParkedCars(context);
  AddOncomingCars(context);
  AddCarsAhead(context, camera_distance_m);
  AddLorry(context, camera_distance_m);
  AddPedestrians(context);
  AddCrossingPedestrians(context, camera_distance_m);
  return builder.Take();
}

}  // namespace evo::simulation
