#include "simulation/world/world.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>

#include "evo/core/error.hpp"
#include "evo/core/parameters.hpp"
#include "evo/simulation/simulated_run.hpp"

namespace evo::simulation {
namespace {

constexpr double kHalfCar = 0.9;  // half of the width that the camera's car takes, m

SceneOptions Load(const std::string& name, int seed) {
  SceneOptions options;
  Parameters parameters;
  Register(parameters, options);
  parameters.LoadFile(std::filesystem::path(EVO_SOURCE_DIR) / "configs" / "scenes" / name);
  options.seed = seed;
  return options;
}

constexpr std::array kDrives = {"driving_day.yaml", "stop_and_go.yaml", "traffic.yaml", "turns.yaml", "highway.yaml"};

struct Hit {
  double a = 0.0;         ///< along edge_u
  double distance = 0.0;  ///< in lengths of the ray
};

/// Where a ray meets a surface, in the surface's body's frame.
std::optional<Hit> Meet(const Surface& surface, const Eigen::Vector3d& origin, const Eigen::Vector3d& ray) {
  Eigen::Matrix3d columns;
  columns << surface.edge_u, surface.edge_v, -ray;
  if (std::abs(columns.determinant()) < 1e-12) return {};
  const Eigen::Vector3d solution = columns.inverse() * (origin - surface.origin);
  if (solution.x() < 0.0 || solution.x() > 1.0 || solution.y() < 0.0 || solution.y() > 1.0) return {};
  return Hit{solution.x(), solution.z()};
}

/// Distance to the nearest static surface along a ray; infinite where there is none.
double Nearest(const Scene& scene, const Eigen::Vector3d& origin, const Eigen::Vector3d& ray) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Surface& surface : scene.surfaces) {
    if (surface.body != 0) continue;
    const auto hit = Meet(surface, origin, ray);
    if (hit && hit->distance > 0.0) nearest = std::min(nearest, hit->distance);
  }
  return nearest;
}

bool operator==(const Surface& a, const Surface& b) {
  return a.origin == b.origin && a.edge_u == b.edge_u && a.edge_v == b.edge_v && a.texture == b.texture &&
         a.texel_origin == b.texel_origin && a.texels == b.texels && a.shade == b.shade && a.body == b.body;
}

/// The camera's place and heading at a time, level.
struct Place {
  Eigen::Vector3d position, forward, right;
};
Place LevelPlace(const SimulatedRun& run, double t) {
  const geometry::SE3 pose = run.T_world_cam(FromSeconds(t));
  Eigen::Vector3d forward = pose.rotation() * Eigen::Vector3d::UnitZ();
  forward.y() = 0.0;
  forward.normalize();
  return {pose.translation(), forward, Eigen::Vector3d::UnitY().cross(forward)};
}

TEST(World, SameSeedSameSceneOtherSeedAnother) {
  for (const auto* name : {"driving_night.yaml", "handheld_boxes.yaml", "slider.yaml"}) {
    const Scene first = *MakeRun(Load(name, 3)).scene;
    const Scene again = *MakeRun(Load(name, 3)).scene;
    const Scene other = *MakeRun(Load(name, 4)).scene;
    EXPECT_TRUE(std::ranges::equal(first.surfaces, again.surfaces, [](auto& a, auto& b) { return a == b; })) << name;
    EXPECT_FALSE(std::ranges::equal(first.surfaces, other.surfaces, [](auto& a, auto& b) { return a == b; })) << name;
    const Texel a = first.textures[0].Lookup(17.3, 5.1, 1.0), b = again.textures[0].Lookup(17.3, 5.1, 1.0);
    EXPECT_EQ(a.reflectance, b.reflectance) << name;
  }
}

TEST(World, ScenesHaveASensibleSizeForManySeeds) {
  for (const auto* name : kDrives) {
    for (const int seed : {0, 9}) {
      const SimulatedRun run = MakeRun(Load(name, seed));
      EXPECT_GT(run.scene->surfaces.size(), 500u) << name << ' ' << seed;
      EXPECT_LT(run.scene->surfaces.size(), 12'000u) << name << ' ' << seed;
      EXPECT_LT(run.scene->textures.size(), 80u) << name << ' ' << seed;
      for (const Surface& surface : run.scene->surfaces) {
        ASSERT_GT(surface.edge_u.cross(surface.edge_v).norm(), 1e-6) << name << ' ' << seed;
        ASSERT_TRUE(surface.origin.allFinite() && surface.texels.allFinite()) << name << ' ' << seed;
      }
    }
  }
}

TEST(World, TheRoadIsUnderTheCamerasWholePath) {
  for (const auto* name : {"driving_day.yaml", "turns.yaml"}) {
    SceneOptions options = Load(name, 11);
    options.vehicle.vibration_deg = 0.0;
    options.vehicle.bumps_at_s = "";
    const SimulatedRun run = MakeRun(options);
    for (double t = 0.0; t <= ToSeconds(run.duration); t += 0.5) {
      const double height =
          Nearest(*run.scene, run.T_world_cam(FromSeconds(t)).translation(), Eigen::Vector3d::UnitY());
      EXPECT_NEAR(height, options.vehicle.camera_height_m, 0.03) << name << " at " << t << " s";
    }
  }
}

// Rays across and along the camera's car, from knee to roof: nothing that stands still is in its way.
TEST(World, NothingStaticLiesInTheCamerasPath) {
  for (const auto* name : {"driving_day.yaml", "turns.yaml", "highway.yaml"}) {
    for (const int seed : {1, 2}) {
      const SimulatedRun run = MakeRun(Load(name, seed));
      for (double t = 0.0; t <= ToSeconds(run.duration); t += 0.5) {
        const Place place = LevelPlace(run, t);
        for (const double up : {-1.0, -0.5, 0.0, 0.5}) {
          const Eigen::Vector3d from = place.position - kHalfCar * place.right - Eigen::Vector3d(0.0, up, 0.0);
          EXPECT_GT(Nearest(*run.scene, from, place.right), 2.0 * kHalfCar) << name << ' ' << seed << " at " << t;
        }
        EXPECT_GT(Nearest(*run.scene, place.position, place.forward), 2.0) << name << ' ' << seed << " at " << t;
      }
    }
  }
}

TEST(World, MovingCarsKeepToTheirLaneAndApart) {
  for (const auto* name : {"traffic.yaml", "highway.yaml", "turns.yaml"}) {
    for (const int seed : {1, 5}) {
      SceneOptions options = Load(name, seed);
      options.street.cars_ahead = std::max(2, options.street.cars_ahead);
      const SimulatedRun run = MakeRun(options);
      ASSERT_GT(run.scene->bodies.size(), 3u);
      const double lane = 0.5 * options.street.road_width_m;
      for (double t = 0.0; t < ToSeconds(run.duration); t += 0.25) {
        std::vector<Eigen::Vector3d> cars;
        const Place place = LevelPlace(run, t);
        for (std::size_t i = 1; i < run.scene->bodies.size(); ++i) {
          const geometry::SE3 car = run.scene->bodies[i].T_world_body(FromSeconds(t));
          const Eigen::Vector3d offset = car.translation() - place.position;
          const double ahead = offset.dot(place.forward), across = offset.dot(place.right);
          // Where the camera passes it, an oncoming car is in the other lane; one ahead stays a car's length away.
          const bool oncoming = (car.rotation() * Eigen::Vector3d::UnitZ()).dot(place.forward) < -0.9;
          if (std::abs(ahead) < 2.0 && oncoming) {
            EXPECT_NEAR(across, -lane, 0.6) << name << ' ' << t;
          }
          if (std::hypot(ahead, across) < 4.5 && !oncoming) {
            EXPECT_GT(std::abs(across), 2.0) << name << ' ' << t;
          }
          for (const auto& other : cars) EXPECT_GT((other - car.translation()).norm(), 1.9) << name << ' ' << t;
          cars.push_back(car.translation());
        }
      }
    }
  }
}

TEST(World, CarsAheadDriveAsTheCameraDoes) {
  SceneOptions options = Load("stop_and_go.yaml", 3);
  options.street.cars_ahead = 1;
  options.street.oncoming_cars_per_100_m = 0.0;
  options.vehicle.vibration_deg = 0.0;
  const SimulatedRun run = MakeRun(options);
  ASSERT_EQ(run.scene->bodies.size(), 2u);
  const auto gap = [&](double t) {
    return run.scene->bodies[1].T_world_body(FromSeconds(t)).translation().z() -
           run.T_world_cam(FromSeconds(t)).translation().z();
  };
  EXPECT_GE(gap(0.0), 7.0);  // standing
  EXPECT_LE(gap(0.0), 9.1);
  EXPECT_NEAR(gap(10.0) - gap(0.0), 1.3 * 7.5, 0.01);  // 1.3 s ahead
  EXPECT_NEAR(gap(18.5), gap(0.0), 0.01) << "stands as close again";
}

// A picture reads from left to right if its u points to the right of who looks at it, its v down: then u x v points
// away from him.
TEST(World, FrontsAndSignsAreNotMirrored) {
  for (const int seed : {1, 2}) {
    SceneOptions options = Load("stop_and_go.yaml", seed);  // straight along z
    options.street.trees_per_100_m = 0.0;
    const Scene scene = *MakeRun(options).scene;
    int fronts = 0, signs = 0;
    for (const Surface& surface : scene.surfaces) {
      const Eigen::Vector3d away = surface.edge_u.cross(surface.edge_v).normalized();
      const Eigen::Vector3d centre = surface.origin + 0.5 * (surface.edge_u + surface.edge_v);
      if (surface.edge_v.normalized().y() < 0.99 || surface.body != 0) continue;
      const bool front = std::abs(away.x()) > 0.99 && std::abs(centre.x()) < 15.0 && surface.edge_u.norm() > 2.0;
      // A floor of a house, 3.1 m high: 128 texels.
      if (front && std::abs(surface.edge_v.y() / surface.texels.y() - 3.1 / 128.0) < 1e-6) {
        EXPECT_GT(away.x() * centre.x(), 0.0) << centre.transpose();
        ++fronts;
      }
      // Traffic signs are 0.7 m square and meant for us.
      if (std::abs(surface.edge_u.norm() - 0.7) < 1e-6 && std::abs(surface.edge_v.norm() - 0.7) < 1e-6) {
        EXPECT_GT(away.z(), 0.99) << centre.transpose();
        ++signs;
      }
    }
    EXPECT_GT(fronts, 40);
    EXPECT_GT(signs, 2);
  }
}

TEST(World, BoxesAndPostersOfTheRoomAreNotMirrored) {
  for (const auto* name : {"handheld_boxes.yaml", "slider.yaml"}) {
    const Scene scene = *MakeRun(Load(name, 7)).scene;
    int seen = 0;
    for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
      const Surface& surface = scene.surfaces[i];
      const Eigen::Vector3d centre = surface.origin + 0.5 * (surface.edge_u + surface.edge_v);
      const bool upright = surface.edge_v.normalized().y() > 0.99 && surface.edge_u.norm() < 1.5;
      if (!upright || Nearest(scene, Eigen::Vector3d::Zero(), centre) < 0.999) continue;  // hidden from the start
      EXPECT_GT(surface.edge_u.cross(surface.edge_v).dot(centre), 0.0) << name << ' ' << centre.transpose();
      ++seen;
    }
    EXPECT_GT(seen, 8) << name;
  }
}

}  // namespace
}  // namespace evo::simulation
