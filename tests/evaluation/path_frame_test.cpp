#include "evaluation/trajectory/path_frame.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "evaluation/straight_path.hpp"

namespace evo::evaluation {
namespace {

TEST(UpDirection, FollowsTheCameraInEveryWorld) {
  const auto camera_world = StraightAhead(3, 1.0);
  EXPECT_EQ(UpDirection("auto", camera_world), -Eigen::Vector3d::UnitY());
  geometry::Trajectory surveyed;  // z up, the camera looks along x, tilted by 20 degrees
  Eigen::Matrix3d axes;
  axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const Eigen::Quaterniond tilt = geometry::so3::Exp({20.0 * std::numbers::pi / 180.0, 0, 0});
  surveyed.push_back({0, geometry::SE3(Eigen::Quaterniond(axes) * tilt, Eigen::Vector3d::Zero())});
  EXPECT_EQ(UpDirection("auto", surveyed), Eigen::Vector3d::UnitZ());
  EXPECT_EQ(UpDirection("-x", surveyed), -Eigen::Vector3d::UnitX());
  EXPECT_EQ(UpDirection("y", surveyed), Eigen::Vector3d::UnitY());
}

TEST(PathFrame, ResolvesErrorsInAheadLeftAndUp) {
  const auto truth = StraightAhead(21, 0.5);
  PathFrame frame(truth, UpDirection("auto", truth), "travel", 1.0);
  const geometry::SE3& T_world_cam = truth[10].T_world_cam;
  // Ahead is z, left is -x, up is -y.
  const auto error =
      frame.Resolve(truth[10].t, T_world_cam, T_world_cam.translation() + Eigen::Vector3d(-0.3, -0.2, 0.4));
  EXPECT_NEAR(error.longitudinal, 0.4, 1e-12);
  EXPECT_NEAR(error.lateral, 0.3, 1e-12);
  EXPECT_NEAR(error.vertical, 0.2, 1e-12);
  EXPECT_NEAR(error.planar, 0.5, 1e-12);
}

TEST(PathFrame, LongitudinalIsTheDirectionOfTravelNotOfView) {
  std::vector<Eigen::Vector3d> positions;  // the camera looks along z but slides to the right
  for (int i = 0; i < 20; ++i) positions.push_back({0.3 * i, 0, 0});
  const auto truth = TrajectoryAlong(positions);
  PathFrame frame(truth, -Eigen::Vector3d::UnitY(), "travel", 1.0);
  const Eigen::Vector3d estimate = positions[7] + Eigen::Vector3d(1, 0, 0);
  EXPECT_NEAR(frame.Resolve(truth[7].t, truth[7].T_world_cam, estimate).longitudinal, 1.0, 1e-12);
}

TEST(PathFrame, KeepsItsHeadingThroughATremblingStop) {
  std::vector<Eigen::Vector3d> positions;
  for (int i = 0; i < 10; ++i) positions.push_back({0, 0, 0.5 * i});
  for (int i = 0; i < 100; ++i) positions.push_back({0.01 * std::sin(3.0 * i), 0, 4.5 + 0.01 * std::cos(5.0 * i)});
  const auto truth = TrajectoryAlong(positions);
  PathFrame frame(truth, -Eigen::Vector3d::UnitY(), "travel", 1.0);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const geometry::SE3& T_world_cam = truth[i].T_world_cam;
    const Eigen::Vector3d estimate = T_world_cam.translation() + Eigen::Vector3d(0, 0, 1);
    EXPECT_NEAR(frame.Resolve(truth[i].t, T_world_cam, estimate).longitudinal, 1.0, 1e-3) << i;
  }
}

TEST(PathFrame, StandingStillFallsBackOnTheViewDirection) {
  const auto truth = StraightAhead(5, 0.0);
  PathFrame frame(truth, -Eigen::Vector3d::UnitY(), "travel", 1.0);
  const auto error = frame.Resolve(truth[2].t, truth[2].T_world_cam, {0.2, 0, 1.0});
  EXPECT_NEAR(error.longitudinal, 1.0, 1e-12);
  EXPECT_NEAR(error.lateral, -0.2, 1e-12);
}

TEST(PathFrame, HandlesACameraThatLooksDownAndStandsStill) {
  geometry::Trajectory truth{
      {0, geometry::SE3(geometry::so3::Exp({-std::numbers::pi / 2, 0, 0}), Eigen::Vector3d::Zero())}};
  const Eigen::Vector3d up = truth[0].T_world_cam.rotation() * -Eigen::Vector3d::UnitZ();
  PathFrame frame(truth, up, "travel", 1.0);
  const auto error = frame.Resolve(0, truth[0].T_world_cam, {0.3, 0.2, 0.4});
  EXPECT_NEAR(std::hypot(error.longitudinal, error.lateral), error.planar, 1e-12);
  EXPECT_GT(error.planar, 0.0);
}

TEST(PathFrame, BodyUsesTheAxesOfTheCamera) {
  geometry::Trajectory truth = StraightAhead(5, 0.5);
  const geometry::SE3 pose(geometry::so3::Exp({0.0, 0.5 * std::numbers::pi, 0.0}),
                           {0, 0, 1.0});  // looks along x, right is -z
  PathFrame frame(truth, -Eigen::Vector3d::UnitY(), "body", 1.0);
  const auto error = frame.Resolve(truth[2].t, pose, Eigen::Vector3d(0.3, -0.2, 1.4));
  EXPECT_NEAR(error.longitudinal, 0.3, 1e-12);
  EXPECT_NEAR(error.lateral, 0.4, 1e-12);
  EXPECT_NEAR(error.vertical, 0.2, 1e-12);
  EXPECT_NEAR(error.planar, 0.5, 1e-12);
}

}  // namespace
}  // namespace evo::evaluation
