#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "simulation/render_scene.hpp"

namespace evo::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

struct Drive {
  TimeNs from = FromSeconds(0.2);
  TimeNs to = 0;
  geometry::SE3 pose_from;
  geometry::SE3 pose_to;
};

Drive RandomDrive(Random* random, double seconds) {
  Drive drive;
  drive.to = drive.from + FromSeconds(seconds);
  drive.pose_from = geometry::SE3(geometry::so3::Exp(RandomVector(random, 0.5)), RandomVector(random, 5.0));
  const Vector3d way = RandomVector(random, 10.0 * seconds);
  drive.pose_to = geometry::SE3(drive.pose_from.rotation() * geometry::so3::Exp(RandomVector(random, 2.0 * seconds)),
                                drive.pose_from.translation() + way);
  return drive;
}

TEST(FindVisible, NeverMissesASurface) {
  const geometry::Camera lens = Davis346();
  Random random(5);
  std::size_t named = 0;
  std::size_t hits = 0;
  for (int round = 0; round < 12; ++round) {
    const Scene scene = RandomScene(200, 100 + round);
    const Renderer renderer(scene, lens, 2);
    const Drive drive = RandomDrive(&random, round < 6 ? 0.005 : 0.1);
    for (const Tile& tile :
         {Tile{0, 0, 16, 16}, Tile{160, 120, 16, 16}, Tile{330, 96, 16, 30}, Tile{90, 200, 40, 60}}) {
      const auto visible = renderer.FindVisible(tile, drive.from, drive.to, drive.pose_from, drive.pose_to).surfaces;
      EXPECT_TRUE(std::is_sorted(visible.begin(), visible.end()));
      named += visible.size();
      for (int i = 0; i < 150; ++i) {
        const double s = random.Uniform();
        const Vector2d pixel(tile.x0 - 0.5 + tile.width * random.Uniform(),
                             tile.y0 - 0.5 + tile.height * random.Uniform());
        const auto t = drive.from + static_cast<TimeNs>(s * static_cast<double>(drive.to - drive.from));
        const Hit hit =
            CastRay(scene, *lens.Undistort(pixel), t, geometry::Interpolate(drive.pose_from, drive.pose_to, s));
        if (hit.surface < 0) continue;
        ++hits;
        ASSERT_TRUE(std::binary_search(visible.begin(), visible.end(), hit.surface)) << round << " " << hit.surface;
      }
    }
  }
  EXPECT_GT(hits, 3000U);
  EXPECT_LT(named, 12U * 4U * 200U / 4U) << "most must be left out";
}

TEST(ImageSpeed, IsAnUpperBound) {
  const geometry::Camera lens = Davis346();
  Random random(8);
  double sum = 0.0;
  double bounds = 0.0;
  for (int round = 0; round < 20; ++round) {
    const Scene scene = RandomScene(80, 200 + round);
    const Renderer renderer(scene, lens, 2);
    const Drive drive = RandomDrive(&random, 0.005);
    for (const Tile& tile : CutIntoTiles(346, 260, 32)) {
      const auto visible = renderer.FindVisible(tile, drive.from, drive.to, drive.pose_from, drive.pose_to);
      const double bound = renderer.ImageSpeed(tile, visible, drive.from, drive.to, drive.pose_from, drive.pose_to);
      double most = 0.0;
      for (int i = 0; i < 60; ++i) {
        const Vector2d pixel(tile.x0 + random.Index(tile.width), tile.y0 + random.Index(tile.height));
        const Vector2d ray = *lens.Undistort(pixel);
        const Hit hit = CastRay(scene, ray, drive.from, drive.pose_from);
        Vector3d moved = drive.pose_to.rotation().conjugate() * (drive.pose_from.rotation() * ray.homogeneous());
        if (hit.surface >= 0) {
          const int body = scene.surfaces[hit.surface].body;
          const geometry::SE3 motion = drive.pose_to.Inverse() * BodyPose(scene, body, drive.to) *
                                       BodyPose(scene, body, drive.from).Inverse() * drive.pose_from;
          moved = motion * (hit.depth * Vector3d(ray.homogeneous()));
        }
        if (moved.z() < 0.1 * (hit.surface < 0 ? 1.0 : hit.depth)) continue;
        const double speed = (lens.Project(moved) - pixel).norm() / ToSeconds(drive.to - drive.from);
        if (speed > 30'000.0) continue;  // hundreds of pixels: not a small motion
        most = std::max(most, speed);
      }
      EXPECT_LT(most, 1.1 * bound) << round << " " << tile.x0 << " " << tile.y0;
      sum += most;
      bounds += std::min(bound, 30'000.0);
    }
  }
  EXPECT_LT(bounds, 4.0 * sum) << "and not a useless one";
}

TEST(ImageSpeed, KnowsAWallAndTheSky) {
  const geometry::Camera lens = Davis240();
  const TimeNs t = FromSeconds(0.01);
  Scene scene = Empty();
  const Tile tile{124, 102, 16, 16};  // the middle, where a pixel is 1 / focal wide
  const Vector3d way(0.02, 0.0, 0.0);
  {
    const Renderer sky(scene, lens, 2);
    EXPECT_EQ(sky.ImageSpeed(tile, All(scene), 0, t, geometry::SE3(), geometry::SE3({1, 0, 0, 0}, way)), 0.0);
    const geometry::SE3 turned(geometry::so3::Exp({0.0, 0.01, 0.0}), Vector3d::Zero());
    EXPECT_NEAR(sky.ImageSpeed(tile, All(scene), 0, t, geometry::SE3(), turned), 199.0, 4.0);
  }
  scene.surfaces.push_back(Facing(-9, 9, -9, 9, 4));
  const Renderer wall(scene, lens, 2);
  EXPECT_NEAR(wall.ImageSpeed(tile, All(scene), 0, t, geometry::SE3(), geometry::SE3({1, 0, 0, 0}, way)),
              199.0 * 2.0 / 4.0, 2.0);
  EXPECT_EQ(wall.ImageSpeed(tile, All(scene), 0, t, geometry::SE3(), geometry::SE3()), 0.0);
}

}  // namespace
}  // namespace evo::simulation
