#include "evo/simulation/true_maps.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "evo/core/parallel.hpp"
#include "simulation/render_scene.hpp"

namespace evo::simulation {
namespace {

const geometry::SE3 kPose(geometry::so3::Exp({0.05, -0.1, 0.2}), {0.3, -0.2, 0.5});
constexpr TimeNs kTime = 40'000'000;

TEST(DepthCamera, AgreesWithOneRayAtATime) {
  const Scene scene = RandomScene(150, 6);
  for (const geometry::Camera& camera : {Davis346(), geometry::Camera(geometry::Rectified(Davis346().calibration()))}) {
    ThreadPool pool(2);
    const events::DepthMap map = DepthCamera(scene, camera, &pool).Render(kTime, kPose);
    ASSERT_EQ(map.width, 346);
    ASSERT_EQ(map.height, 260);
    int seen = 0, moving = 0;
    for (int y = 0; y < map.height; y += 9) {
      for (int x = 0; x < map.width; x += 9) {
        const Hit hit = CastRay(scene, *camera.Undistort({x, y}), kTime, kPose);
        if (hit.margin < 1e-4) continue;
        ASSERT_EQ(hit.surface >= 0, std::isfinite(map.At(x, y))) << x << ", " << y;
        if (hit.surface < 0) continue;
        ++seen;
        const bool moves = scene.surfaces[static_cast<std::size_t>(hit.surface)].body != 0;
        moving += moves ? 1 : 0;
        EXPECT_EQ(map.IsMoving(x, y), moves) << x << ", " << y;
        EXPECT_NEAR(map.At(x, y), hit.depth, 1e-4 * hit.depth);
      }
    }
    EXPECT_GT(seen, 250);
    EXPECT_GT(moving, 50);
    EXPECT_LT(moving, seen);
  }
}

TEST(DepthCamera, IsTheSameForAnyNumberOfThreads) {
  const Scene scene = RandomScene(40, 6);
  const geometry::Camera camera = Davis240();
  ThreadPool one(1);
  ThreadPool three(3);
  const events::DepthMap map = DepthCamera(scene, camera, &one).Render(kTime, kPose);
  const events::DepthMap same = DepthCamera(scene, camera, &three).Render(kTime, kPose);
  EXPECT_EQ(map.moving, same.moving);
  for (std::size_t i = 0; i < map.depth.size(); ++i) {
    ASSERT_TRUE(map.depth[i] == same.depth[i] || (std::isnan(map.depth[i]) && std::isnan(same.depth[i]))) << i;
  }
}

class StaticFlowTest : public ::testing::Test {
 protected:
  events::FlowMap Flow(const geometry::SE3& T_next_now) const { return StaticFlow(camera, depth, T_next_now); }
  double Right(const events::FlowMap& map, int x, int y) const {
    return map.flow[static_cast<std::size_t>(y * 20 + x)];
  }
  double Down(const events::FlowMap& map, int x, int y) const {
    return map.flow[static_cast<std::size_t>(300 + y * 20 + x)];
  }

  const geometry::Camera camera{
      geometry::Calibration{geometry::Distortion::kRadTan, 20, 15, 50.0, 40.0, 10.0, 7.0, {}}};
  events::DepthMap depth{20, 15, std::vector<double>(300, 4.0)};
};

TEST_F(StaticFlowTest, OfAStepSidewaysIsFocalLengthTimesStepOverDepth) {
  const events::FlowMap map =
      Flow(geometry::SE3(Eigen::Quaterniond::Identity(), {-0.2, 0.1, 0.0}));  // camera goes right and up
  for (const auto& [x, y] : {std::pair(0, 0), std::pair(19, 3), std::pair(7, 14)}) {
    EXPECT_NEAR(Right(map, x, y), -50.0 * 0.2 / 4.0, 1e-9);
    EXPECT_NEAR(Down(map, x, y), 40.0 * 0.1 / 4.0, 1e-9);
  }
}

TEST_F(StaticFlowTest, OfAStepForwardExpandsFromTheAxis) {
  const events::FlowMap map =
      Flow(geometry::SE3(Eigen::Quaterniond::Identity(), {0.0, 0.0, -1.0}));  // 4 m to 3 m: a third wider
  EXPECT_NEAR(Right(map, 10, 7), 0.0, 1e-9);
  EXPECT_NEAR(Right(map, 16, 7), 2.0, 1e-9);
  EXPECT_NEAR(Down(map, 16, 1), -2.0, 1e-9);
}

TEST_F(StaticFlowTest, OfARotationDoesNotDependOnDepth) {
  depth.depth[0] = 400.0;
  const geometry::SE3 turn(geometry::so3::Exp({0.0, 0.0, 0.01}), Eigen::Vector3d::Zero());
  const events::FlowMap map = Flow(turn);
  const Eigen::Vector2d place = camera.Project(turn * Eigen::Vector3d((0.0 - 10.0) / 50.0, (0.0 - 7.0) / 40.0, 1.0));
  EXPECT_NEAR(Right(map, 0, 0), place.x(), 1e-9);
  EXPECT_NEAR(Down(map, 0, 0), place.y(), 1e-9);
}

TEST_F(StaticFlowTest, IsUnknownForUnknownDepthAndForPointsBehindTheCamera) {
  depth.depth[0] = std::nan("");
  depth.depth[1] = 0.5;
  const events::FlowMap map = Flow(geometry::SE3(Eigen::Quaterniond::Identity(), {0.0, 0.0, -1.0}));
  EXPECT_TRUE(std::isnan(Right(map, 0, 0)));
  EXPECT_TRUE(std::isnan(Down(map, 1, 0)));
  EXPECT_FALSE(std::isnan(Right(map, 2, 0)));
}

}  // namespace
}  // namespace evo::simulation
