#include "odometry/frontend/frame_builder.hpp"

#include <gtest/gtest.h>

#include "evo/core/error.hpp"
#include "odometry/synthetic_drive.hpp"

namespace evo::odometry {
namespace {

TEST(FrameBuilder, UndistortsFeaturesWithTheirPixelJacobian) {
  const geometry::Camera camera = testing::DriveCamera();
  const events::Tracks tracks = {
      {3, 10, 300.0, 40.0}, {7, 10, 50.0, 200.0}, {7, 10, 50.0, 200.0}, {3, 20, 301.0, 41.0}};
  const auto frames = BuildFrames(tracks, camera);
  ASSERT_EQ(frames.size(), 2u);
  ASSERT_EQ(frames[0].features.size(), 2u);  // the duplicate counts once
  EXPECT_EQ(frames[1].t, 20);
  const Feature* const feature = frames[0].Find(3);
  ASSERT_TRUE(feature);
  EXPECT_FALSE(frames[1].Find(7));
  EXPECT_LT((camera.Distort(feature->x) - Eigen::Vector2d(300.0, 40.0)).norm(), 1e-6);
  const Eigen::Vector2d d(1e-3, -2e-3);
  const Eigen::Vector2d moved = camera.Distort(feature->x + d) - camera.Distort(feature->x);
  EXPECT_LT((feature->J_pixel_normalized * d - moved).norm(), 5e-3);
}

TEST(FrameBuilder, RejectsTracksOffTheSensor) {
  const events::Tracks tracks = {{1, 0, 10, 10}, {2, 0, 400, 10}};
  EXPECT_THROW(BuildFrames(tracks, testing::DriveCamera()), Error);
}

}  // namespace
}  // namespace evo::odometry
