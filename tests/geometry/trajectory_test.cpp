#include "evo/geometry/trajectory.hpp"

#include <gtest/gtest.h>

namespace evo::geometry {
namespace {

TEST(Trajectory, InterpolatesPosesButNotBeyondTheEndsOrAcrossGaps) {
  const SE3 rotated(so3::Exp({0, 0, 0.4}), Eigen::Vector3d(2, 0, 0));
  const Trajectory trajectory{{100, SE3()}, {200, rotated}, {900, rotated}};
  EXPECT_FALSE(PoseAt({}, 100, 1000));
  EXPECT_FALSE(PoseAt(trajectory, 99, 1000));
  EXPECT_FALSE(PoseAt(trajectory, 901, 1000));
  EXPECT_FALSE(PoseAt(trajectory, 201, 699));
  EXPECT_TRUE(PoseAt(trajectory, 201, 700));
  EXPECT_EQ(PoseAt(trajectory, 200, 0)->translation().x(), 2.0);
  const auto middle = PoseAt(trajectory, 125, 1000);
  EXPECT_DOUBLE_EQ(middle->translation().x(), 0.5);
  EXPECT_NEAR(so3::Log(middle->rotation()).z(), 0.1, 1e-12);
}

TEST(Trajectory, PathLengthIsTheSumOfSteps) {
  EXPECT_EQ(PathLength({}), 0.0);
  const SE3 corner({1, 0, 0, 0}, Eigen::Vector3d(3, 0, 4));
  EXPECT_DOUBLE_EQ(PathLength({{0, SE3()}, {1, corner}, {2, corner}, {3, SE3()}}), 10.0);
}

}  // namespace
}  // namespace evo::geometry
