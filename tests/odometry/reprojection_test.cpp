#include "odometry/bundle/reprojection.hpp"

#include <gtest/gtest.h>

#include "odometry/bundle_drive.hpp"

namespace evo::odometry {
namespace {

TEST(Reprojection, JacobiansMatchFiniteDifferences) {
  const auto problem = testing::DriveBundle(8, 6, 15.0, 1);
  const double h = 1e-6;
  for (const auto& observation : problem.observations) {
    const BundlePoint& point = problem.points[observation.point];
    const geometry::SE3 pose = problem.T_cam_world[observation.frame] * problem.T_cam_world[point.anchor].Inverse();
    const Eigen::Vector3d& inverse_depth = point.inverse_depth;
    LinearizedReprojection at, plus, minus;
    ASSERT_TRUE(LinearizeReprojection(pose, inverse_depth, observation, &at));
    for (int k = 0; k < 6; ++k) {
      const geometry::Vector6d d = h * geometry::Vector6d::Unit(k);
      ASSERT_TRUE(LinearizeReprojection(geometry::SE3::Exp(d) * pose, inverse_depth, observation, &plus));
      ASSERT_TRUE(LinearizeReprojection(geometry::SE3::Exp(-d) * pose, inverse_depth, observation, &minus));
      EXPECT_LT((at.J_error_pose.col(k) - (plus.error - minus.error) / (2 * h)).norm(), 1e-4);
    }
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d more = inverse_depth + h * Eigen::Vector3d::Unit(k);
      const Eigen::Vector3d less = inverse_depth - h * Eigen::Vector3d::Unit(k);
      ASSERT_TRUE(LinearizeReprojection(pose, more, observation, &plus));
      ASSERT_TRUE(LinearizeReprojection(pose, less, observation, &minus));
      EXPECT_LT((at.J_error_point.col(k) - (plus.error - minus.error) / (2 * h)).norm(), 1e-3);
    }
  }
}

}  // namespace
}  // namespace evo::odometry
