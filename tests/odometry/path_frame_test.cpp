#include "odometry/scale/path_frame.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace evo::odometry {
namespace {

constexpr double kRadius = 50.0;

/// A curve to the left in the plane y = 0 (y down), starting at the origin along z.
Eigen::Vector3d OnCurve(double arc_length) {
  const double angle = arc_length / kRadius;
  return {kRadius * (std::cos(angle) - 1.0), 0.0, kRadius * std::sin(angle)};
}

PathFrame MakeCurve() {
  std::vector<Eigen::Vector3d> positions, down;
  for (int i = 0; i <= 300; ++i) {
    positions.push_back(OnCurve(0.1 * i));
    down.push_back(Eigen::Vector3d::UnitY());
  }
  return {positions, down, 2.0};
}

TEST(PathFrame, LocatesAPointBesideACurve) {
  const PathFrame path = MakeCurve();
  EXPECT_NEAR(path.length(), 30.0, 0.2);
  const double angle = 20.0 / kRadius;
  const Eigen::Vector3d right(std::cos(angle), 0.0, std::sin(angle));
  const auto place = path.Locate(OnCurve(20.0) + 2.0 * right + Eigen::Vector3d(0.0, 1.5, 0.0), 120, 10.0);
  ASSERT_TRUE(place);
  EXPECT_NEAR(place->arc_length, 20.0, 0.05);
  EXPECT_NEAR(place->below, 1.5, 0.01);
  EXPECT_NEAR(place->right, 2.0, 0.05);
  EXPECT_LT((place->down - Eigen::Vector3d::UnitY()).norm(), 1e-6);
}

TEST(PathFrame, LocatesNoPointBeyondThePathOrTheDistance) {
  const PathFrame path = MakeCurve();
  const Eigen::Vector3d below(0.0, 1.5, 0.0);
  EXPECT_FALSE(path.Locate(OnCurve(35.0) + below, 290, 10.0));
  EXPECT_FALSE(path.Locate(OnCurve(25.0) + below, 100, 10.0));
  EXPECT_TRUE(path.Locate(OnCurve(25.0) + below, 200, 10.0));
}

}  // namespace
}  // namespace evo::odometry
