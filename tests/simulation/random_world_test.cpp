#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "evo/core/parameters.hpp"
#include "evo/simulation/random_scene.hpp"
#include "evo/simulation/simulated_run.hpp"
#include "simulation/world/scene.hpp"
#include "simulation/world/street.hpp"
#include "simulation/world/textures.hpp"

// What the random drives need of the world: lanes, moving bodies, light and contrast.

namespace evo::simulation {
namespace {

SceneOptions Drive() {
  SceneOptions options;
  options.road_shape = "straight";
  options.street.trees_per_100_m = 0.0;
  options.street.parked_cars_per_100_m = 0.0;
  options.street.oncoming_cars_per_100_m = 0.0;
  options.vehicle.duration_s = 12.0;
  options.vehicle.start_at_rest_s = 0.0;
  options.vehicle.vibration_deg = 0.0;
  return options;
}

Eigen::Vector3d PositionOf(const Scene& scene, std::size_t body, double t) {
  return scene.bodies[body].T_world_body(FromSeconds(t)).translation();
}

TEST(RandomWorld, EveryDrawnSceneCanBeMade) {
  const auto file = std::filesystem::path(EVO_SOURCE_DIR) / "configs" / "scenes" / "random.yaml";
  std::set<std::string> seen;
  for (int seed = 1; seed <= 60; ++seed) {
    SceneOptions options;
    Parameters parameters;
    Register(parameters, options);
    const auto drawn = LoadScene(file, seed, &options, &parameters);
    ASSERT_TRUE(drawn);
    for (const auto& [name, alternative] : *drawn) seen.insert(name + "=" + alternative);
    if (seed > 6) continue;  // worlds take a while
    const SimulatedRun run = MakeRun(options);
    EXPECT_GE(ToSeconds(run.duration), 10.0);
    EXPECT_GT(run.scene->surfaces.size(), 300u) << seed;
  }
  for (const char* name : {"light=day", "light=dusk", "light=night", "light=wet_night", "place=country", "place=city",
                           "traffic=lorry", "bonnet=seen", "sensor=vga", "stops=one", "hot_pixels=many"}) {
    EXPECT_TRUE(seen.contains(name)) << name;
  }
}

TEST(RandomWorld, CameraParametersMakeACalibration) {
  SceneOptions options = Drive();
  options.calibration = "camera";
  options.camera = {.width_px = 640,
                    .height_px = 480,
                    .focal_px = 400.0,
                    .centre_x_px = 5.0,
                    .centre_y_px = -3.0,
                    .distortion = "radtan",
                    .k1 = -0.2,
                    .k2 = 0.05};
  const geometry::Calibration found = MakeRun(options).camera.calibration();
  EXPECT_EQ(found.distortion, geometry::Distortion::kRadTan);
  EXPECT_EQ(found.width, 640);
  EXPECT_EQ(found.height, 480);
  EXPECT_EQ(found.fx, 400.0);
  EXPECT_EQ(found.cx, 324.5);
  EXPECT_EQ(found.cy, 236.5);
  EXPECT_EQ(found.coefficients[0], -0.2);
  EXPECT_EQ(found.coefficients[1], 0.05);
}

TEST(RandomWorld, LeftHandTrafficMirrorsTheLanes) {
  SceneOptions options = Drive();
  options.street.oncoming_cars_per_100_m = 2.0;
  for (const bool left : {false, true}) {
    options.street.left_hand_traffic = left;
    const Scene scene = *MakeRun(options).scene;
    const double lane = (left ? 0.5 : -0.5) * options.street.road_width_m;
    ASSERT_GT(scene.bodies.size(), 3u);
    for (std::size_t i = 1; i < scene.bodies.size(); ++i) EXPECT_NEAR(PositionOf(scene, i, 1.0).x(), lane, 1e-6);
  }
}

TEST(RandomWorld, TheStreetLiesBesideACameraThatSitsBesideTheLanesCentre) {
  SceneOptions options = Drive();
  options.street.cars_ahead = 1;
  options.street.camera_lateral_m = 0.4;
  const SimulatedRun run = MakeRun(options);
  EXPECT_NEAR(PositionOf(*run.scene, 1, 2.0).x(), -0.4, 1e-6) << "the car ahead keeps to the lane's centre";
  EXPECT_NEAR(run.T_world_cam(FromSeconds(2.0)).translation().x(), 0.0, 1e-6);
}

TEST(RandomWorld, ALorryPassesInTheOtherLane) {
  SceneOptions options = Drive();
  options.street.lorry = true;
  bool beside = false;
  for (int seed = 1; seed <= 5; ++seed) {
    options.seed = seed;
    const SimulatedRun run = MakeRun(options);
    ASSERT_EQ(run.scene->bodies.size(), 2u);
    for (double t = 0.0; t < 12.0; t += 0.5) {
      const Eigen::Vector3d lorry = PositionOf(*run.scene, 1, t);
      EXPECT_NEAR(lorry.x(), -0.5 * options.street.road_width_m, 1e-6);
      beside = beside || std::abs(lorry.z() - run.T_world_cam(FromSeconds(t)).translation().z()) < 3.0;
    }
  }
  EXPECT_TRUE(beside);
}

TEST(RandomWorld, CrossingPedestriansAreOutOfTheLaneWhenTheCameraComes) {
  SceneOptions options = Drive();
  options.street.crossing_pedestrians_per_100_m = 5.0;
  int crossed = 0;
  for (int seed = 1; seed <= 4; ++seed) {
    options.seed = seed;
    const SimulatedRun run = MakeRun(options);
    const std::size_t bodies = run.scene->bodies.size();
    ASSERT_GT(bodies, 9u);
    ASSERT_EQ((bodies - 1) % 3, 0u) << "a trunk and two legs";
    for (std::size_t i = 1; i < bodies; i += 3) {
      double lowest = 1e9, highest = -1e9;
      for (double t = 0.0; t <= 12.0; t += 0.05) {
        const Eigen::Vector3d place = PositionOf(*run.scene, i, t);
        const double ahead = place.z() - run.T_world_cam(FromSeconds(t)).translation().z();
        if (ahead > 0.0 && ahead < 5.0) {
          EXPECT_GT(std::abs(place.x()), 1.2) << seed << ' ' << i << ' ' << t;
        }
        lowest = std::min(lowest, place.x()), highest = std::max(highest, place.x());
      }
      crossed += lowest < -1.0 && highest > 1.0 ? 1 : 0;
    }
  }
  EXPECT_GT(crossed, 4);
}

TEST(RandomWorld, PedestriansKeepToThePavements) {
  SceneOptions options = Drive();
  options.street.pedestrians_per_100_m = 3.0;
  const SimulatedRun run = MakeRun(options);
  const double centre = -0.25 * options.street.road_width_m;
  const double kerb = 0.5 * options.street.road_width_m + options.street.parking_width_m;
  ASSERT_GT(run.scene->bodies.size(), 9u);
  for (std::size_t i = 1; i < run.scene->bodies.size(); i += 3) {
    const double lateral = std::abs(PositionOf(*run.scene, i, 3.0).x() - centre);
    EXPECT_GT(lateral, kerb);
    EXPECT_LT(lateral, kerb + options.street.pavement_width_m);
  }
}

TEST(RandomWorld, AWetRoadShowsTheLampsBelowIt) {
  SceneOptions options = Drive();
  options.street.light = "night";
  const auto glowing_below = [&](double wetness) {
    options.street.wetness = wetness;
    const Scene scene = *MakeRun(options).scene;
    return std::ranges::count_if(scene.surfaces, [&](const Surface& surface) {
      return surface.emission > 0.0F && surface.origin.y() > options.vehicle.camera_height_m;
    });
  };
  EXPECT_EQ(glowing_below(0.0), 0);
  EXPECT_GT(glowing_below(1.0), 10);
}

TEST(RandomWorld, DuskIsBetweenDayAndNight) {
  SceneOptions options = Drive();
  std::vector<double> ambient, sky;
  for (const char* light : {"night", "dusk", "day"}) {
    options.street.light = light;
    const Scene scene = *MakeRun(options).scene;
    ambient.push_back(scene.lighting.ambient);
    sky.push_back(scene.lighting.sky);
    EXPECT_EQ(scene.lighting.lamps.empty(), std::string(light) == "day");
  }
  EXPECT_TRUE(std::ranges::is_sorted(ambient) && std::ranges::is_sorted(sky));
}

/// Mean square of the differences of neighbouring texels away from markings.
double Roughness(const Texture& texture) {
  double sum = 0.0;
  for (int i = 0; i < 20'000; ++i) {
    const double u = 300.5 + i % 100, v = 0.5 + i / 100;
    const double a = texture.Lookup(u, v, 0.0).reflectance, b = texture.Lookup(u + 1.0, v, 0.0).reflectance;
    if (std::max(a, b) < 0.6) sum += (a - b) * (a - b);
  }
  return sum;
}

TEST(RandomWorld, ARoadWithoutContrastKeepsItsMarkings) {
  Random rich_random(5), poor_random(5);
  const Texture rich = PaintLanes(rich_random, {}, 1024), poor = PaintLanes(poor_random, {}, 1024, 0.1);
  EXPECT_LT(Roughness(poor), 0.05 * Roughness(rich));
  int marked = 0;
  for (int v = 0; v < 1024; ++v) marked += poor.Lookup(512.5, v + 0.5, 0.0).reflectance > 0.6 ? 1 : 0;
  EXPECT_GT(marked, 300) << "the dashes of the centre line";
}

TEST(RandomWorld, MountAnglesTurnTheCamera) {
  SceneOptions options = Drive();
  options.vehicle.camera_yaw_deg = 10.0;
  const Eigen::Vector3d right = MakeRun(options).T_world_cam(0).rotation() * Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(right.x(), std::sin(10.0 * 3.14159265 / 180.0), 1e-6) << "to the right";
  options.vehicle.camera_yaw_deg = 0.0;
  options.vehicle.camera_roll_deg = 10.0;
  const Eigen::Vector3d x = MakeRun(options).T_world_cam(0).rotation() * Eigen::Vector3d::UnitX();
  EXPECT_GT(x.y(), 0.1) << "clockwise: the right side sinks";
}

}  // namespace
}  // namespace evo::simulation
