#include "evo/geometry/triangulation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace evo::geometry {
namespace {

Eigen::Vector2d Project(const SE3& T_cam_world, const Eigen::Vector3d& point) {
  const Eigen::Vector3d p = T_cam_world * point;
  return p.head<2>() / p.z();
}

TEST(Triangulation, PairSolvesEquation6) {
  const SE3 T_2_1(so3::Exp({0.02, -0.1, 0.03}), Eigen::Vector3d(-0.3, 0.1, -1.0));
  const Eigen::Vector3d p1(1.5, -0.7, 9.0);
  const Eigen::Vector3d p2 = T_2_1 * p1;
  const auto depths = TriangulatePair(p1.head<2>() / p1.z(), p2.head<2>() / p2.z(), T_2_1);
  ASSERT_TRUE(depths);
  EXPECT_NEAR(depths->z1, p1.z(), 1e-9);
  EXPECT_NEAR(depths->z2, p2.z(), 1e-9);
}

TEST(Triangulation, ParallelRaysHaveNoDepth) {
  EXPECT_FALSE(TriangulatePair({0.1, 0.2}, {0.1, 0.2}, SE3({1, 0, 0, 0}, Eigen::Vector3d(1, 0, 0))));
  const std::vector<View> same(3, View{SE3(), {0.1, 0.2}});
  EXPECT_FALSE(TriangulateViews(same));
}

TEST(Triangulation, RejectsAPointBehindTheCameras) {
  const Eigen::Vector3d behind(1.0, 0.5, -8.0);
  std::vector<View> views;
  for (int i = 0; i < 3; ++i) {
    const SE3 T_cam_world({1, 0, 0, 0}, Eigen::Vector3d(-0.5 * i, 0, 0));
    views.push_back({T_cam_world, Project(T_cam_world, behind)});
  }
  EXPECT_FALSE(TriangulateViews(views));
}

TEST(Triangulation, CovariancePredictsTheErrorsOfManyViews) {
  const Eigen::Vector3d point(2.0, -1.0, 12.0);
  const double noise = 0.002;
  std::mt19937 random(4);
  std::normal_distribution<double> normal(0.0, noise);
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d foretold = Eigen::Matrix3d::Zero();
  const int trials = 400;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<View> views;
    for (int i = 0; i < 10; ++i) {
      const SE3 T_cam_world(so3::Exp({0, 0.01 * i, 0}), Eigen::Vector3d(0, 0, -0.4 * i));
      views.push_back({T_cam_world, Project(T_cam_world, point) + Eigen::Vector2d(normal(random), normal(random))});
    }
    const auto result = TriangulateViews(views);
    ASSERT_TRUE(result);
    const Eigen::Vector3d error = result->position_world - point;
    spread += error * error.transpose() / trials;
    foretold += noise * noise * result->covariance / trials;
  }
  EXPECT_NEAR(spread(2, 2) / foretold(2, 2), 1.0, 0.3);
  EXPECT_NEAR(spread(0, 0) / foretold(0, 0), 1.0, 0.3);
}

}  // namespace
}  // namespace evo::geometry
