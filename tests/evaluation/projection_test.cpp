#include "evaluation/trajectory/projection.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace evo::evaluation {
namespace {

Eigen::Quaterniond Turn(double x, double y, double z) {
  return geometry::so3::Exp({0, 0, z}) * geometry::so3::Exp({0, y, 0}) * geometry::so3::Exp({x, 0, 0});
}

void ExpectPose(const geometry::SE3& actual, const Eigen::Quaterniond& rotation, const Eigen::Vector3d& position) {
  EXPECT_LT((actual.Matrix() - geometry::SE3(rotation, position).Matrix()).norm(), 1e-12);
}

TEST(Projection, KeepsOnlyTheRotationAboutTheNormal) {
  const geometry::SE3 pose(Turn(0.3, -0.7, 2.1), {1, 2, 3});
  ExpectPose(Project(pose, "none"), pose.rotation(), {1, 2, 3});
  ExpectPose(Project(pose, "xy"), Turn(0, 0, 2.1), {1, 2, 0});
  ExpectPose(Project(pose, "xz"), Turn(0, -0.7, 0), {1, 0, 3});
  ExpectPose(Project(pose, "yz"), Turn(0.3, 0, 0), {0, 2, 3});
}

TEST(Projection, IsIdempotent) {
  const geometry::SE3 pose(Turn(-0.4, 0.5, -3.0), {1, 2, 3});
  for (const char* plane : {"xy", "xz", "yz"}) {
    const geometry::SE3 once = Project(pose, plane);
    ExpectPose(Project(once, plane), once.rotation(), once.translation());
  }
}

TEST(Projection, HandlesGimbalLock) {
  const geometry::SE3 pose(Turn(0.4, 0.5 * std::numbers::pi, 0.0), {1, 2, 3});
  for (const char* plane : {"xy", "xz", "yz"}) EXPECT_TRUE(Project(pose, plane).Matrix().allFinite()) << plane;
  ExpectPose(Project(pose, "xz"), Turn(0, 0.5 * std::numbers::pi, 0), {1, 0, 3});
}

}  // namespace
}  // namespace evo::evaluation
