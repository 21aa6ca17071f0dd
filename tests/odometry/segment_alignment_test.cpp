#include "odometry/mapping/segment_alignment.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <unordered_map>
#include <vector>

namespace evo::odometry {
namespace {

TEST(SegmentAlignment, RecoversASimilarityDespiteOutliers) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-10.0, 10.0);
  const geometry::SE3 T_world_local(geometry::so3::Exp({0.1, 0.7, -0.2}), Eigen::Vector3d(5, -1, 30));
  std::vector<Point> points;
  std::unordered_map<std::int64_t, Eigen::Vector3d> old_points;
  for (int i = 0; i < 30; ++i) {
    points.push_back({i, Eigen::Vector3d(uniform(random), uniform(random), uniform(random)), 0, 0});
    old_points[i] = T_world_local * (2.5 * points.back().position);
    if (i % 7 == 0) old_points[i].x() += 40.0;
  }
  const auto similarity = AlignByPoints(points, old_points);
  ASSERT_TRUE(similarity);
  EXPECT_NEAR(similarity->scale, 2.5, 1e-6);
  EXPECT_LT((similarity->T_world_local.Matrix() - T_world_local.Matrix()).norm(), 1e-5);
  points.resize(5);
  EXPECT_FALSE(AlignByPoints(points, old_points));
}

}  // namespace
}  // namespace evo::odometry
