#include "simulation/render/bonnet_mirror.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "simulation/render_scene.hpp"

namespace evo::simulation {
namespace {

constexpr double kEdge = 0.3;

Bonnet Mirror() { return {.edge = kEdge, .reflectivity = 0.05, .radiance = 0.1}; }

TEST(BonnetMirror, RaysAboveItsEdgePass) {
  const BonnetMirror mirror(Mirror());
  EXPECT_FALSE(mirror.Reflect({0.0, kEdge - 0.001}));
  EXPECT_TRUE(mirror.Reflect({0.0, kEdge + 0.001}));
  EXPECT_FALSE(mirror.Reflect({0.6, kEdge + 0.001})) << "the bonnet falls off to the sides";
}

TEST(BonnetMirror, ReflectsTheSceneAboveUpsideDown) {
  const BonnetMirror mirror(Mirror());
  double last = 1.0;
  for (double y = kEdge + 0.01; y < 1.0; y += 0.05) {
    const auto found = mirror.Reflect({0.0, y});
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->ray.x(), 0.0, 1e-12);
    EXPECT_LT(found->ray.y(), last) << "what is lower shows what is higher";
    EXPECT_NEAR(found->ray.y(), -y, 0.4 * y + 0.1) << "nearly as a level mirror does";
    last = found->ray.y();
  }
  const auto left = mirror.Reflect({-0.3, 0.5}), right = mirror.Reflect({0.3, 0.5});
  EXPECT_NEAR(left->ray.x(), -right->ray.x(), 1e-12);
  EXPECT_GT(right->ray.x(), 0.3) << "convex: it shows more than a plane";
}

TEST(BonnetMirror, ReflectsMoreAtGrazingAngles) {
  const BonnetMirror mirror(Mirror());
  const double far = mirror.Reflect({0.0, 0.31})->reflectivity, near = mirror.Reflect({0.0, 1.2})->reflectivity;
  EXPECT_GT(far, 0.15);
  EXPECT_LT(near, 0.08);
  EXPECT_GE(near, 0.05);
}

TEST(BonnetMirror, FollowsTheMountOfTheCamera) {
  Bonnet bonnet = Mirror();
  bonnet.R_vehicle_cam = geometry::so3::Exp({-0.1, 0.0, 0.0});  // looks down
  const double edge = std::tan(std::atan(kEdge) - 0.1);
  EXPECT_FALSE(BonnetMirror(bonnet).Reflect({0.0, edge - 0.001}));
  EXPECT_TRUE(BonnetMirror(bonnet).Reflect({0.0, edge + 0.001}));
}

TEST(BonnetMirror, IsRenderedOverTheScene) {
  const geometry::Camera lens = Davis346();
  Scene scene = Empty();
  scene.surfaces.push_back(LevelGround());
  scene.bonnet = Mirror();
  const auto image = RenderAll(scene, lens, 2);
  const auto depth = DepthOfAll(scene, lens);
  const BonnetMirror mirror(*scene.bonnet);
  int mirrored = 0;
  for (int y = 0; y < lens.height(); ++y) {
    for (int x = 3; x < lens.width(); x += 7) {
      const auto ray = lens.Undistort({x, y});
      const auto above = lens.Undistort({x, y - 1.5}), below = lens.Undistort({x, y + 1.5});
      if (!ray || !above || !below) continue;
      const std::size_t pixel = static_cast<std::size_t>(y) * lens.width() + x;
      if (mirror.Reflect(*above)) {  // the sky, to the sides the ground, as dark as the bonnet makes them
        const auto reflection = *mirror.Reflect(*ray);
        EXPECT_TRUE(std::isnan(depth[pixel]));
        if (std::abs(reflection.ray.y()) < 0.05) continue;  // the horizon
        const double seen = reflection.ray.y() < 0.0 ? scene.lighting.sky : 0.5;
        EXPECT_NEAR(image[pixel], reflection.reflectivity * seen + 0.1, 0.01) << x << ' ' << y;
        ++mirrored;
      } else if (!mirror.Reflect(*below) && ray->y() > 0.01) {
        EXPECT_NEAR(image[pixel], 0.5, 0.01);
        EXPECT_NEAR(depth[pixel], 1.5 / ray->y(), 1e-3 / ray->y());
      }
    }
  }
  EXPECT_GT(mirrored, 500);
}

}  // namespace
}  // namespace evo::simulation
