#include "simulation/world/reference_line.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "evo/core/error.hpp"

namespace evo::simulation {
namespace {

constexpr double kPi = std::numbers::pi;

/// Position, heading and curvature agree with one another all along the line and beyond its ends.
void ExpectConsistent(const ReferenceLine& road) {
  constexpr double kStep = 0.01;
  for (double s = -20.0; s < road.length() + 150.0; s += 0.0371) {
    const auto before = road.PointAt(s - kStep), at = road.PointAt(s), after = road.PointAt(s + kStep);
    const Eigen::Vector3d slope = (after.position - before.position) / (2.0 * kStep);
    ASSERT_LT((slope - ReferenceLine::Tangent(at)).norm(), 2e-5) << "at " << s;
    ASSERT_NEAR((after.heading - before.heading) / (2.0 * kStep), at.curvature, 3e-4) << "at " << s;
    ASSERT_LT(std::abs(after.curvature - before.curvature), 2.0 * kStep * 0.025) << "at " << s;
    ASSERT_LE(std::abs(at.curvature), 1.0 / 8.0 + 1e-12);
  }
}

TEST(ReferenceLine, StraightRoadFollowsZ) {
  const ReferenceLine road("straight", 440.0, 0.0, 3);
  EXPECT_LT((road.PointAt(123.4).position - Eigen::Vector3d(0.0, 0.0, 123.4)).norm(), 1e-9);
  EXPECT_LT((road.PointAt(-10.0).position - Eigen::Vector3d(0.0, 0.0, -10.0)).norm(), 1e-9);
  EXPECT_LT((road.PointAt(500.0).position - Eigen::Vector3d(0.0, 0.0, 500.0)).norm(), 1e-9);
  EXPECT_EQ(road.PointAt(77.0).heading, 0.0);
  ASSERT_GE(road.junctions().size(), 3U);
  for (const double at : road.junctions()) EXPECT_TRUE(at > 0.0 && at <= 440.0);
}

TEST(ReferenceLine, AllShapesAreContinuousInCurvature) {
  for (const auto* shape : {"straight", "curved", "turns"}) {
    for (const std::uint64_t seed : {1, 2, 3}) {
      SCOPED_TRACE(shape);
      ExpectConsistent(ReferenceLine(shape, 440.0, 0.0, seed));
      ExpectConsistent(ReferenceLine(shape, 440.0, 0.06, seed));
    }
  }
}

TEST(ReferenceLine, TurnsAreFourRightAnglesAtJunctions) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const ReferenceLine road("turns", 440.0, 0.0, seed);
    ASSERT_EQ(road.junctions().size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) {
      const double at = road.junctions()[i];
      const double before = road.PointAt(at - 12.0).heading, after = road.PointAt(at + 12.0).heading;
      EXPECT_NEAR(std::abs(after - before), 0.5 * kPi, 1e-9);
      EXPECT_NEAR(road.PointAt(at).heading, 0.5 * (before + after), 1e-9) << "the middle of the turn";
      EXPECT_NEAR(std::abs(road.PointAt(at).curvature), 1.0 / 8.0, 1e-12);
      if (i > 0) {
        EXPECT_NEAR(at - road.junctions()[i - 1], 80.0, 5.0 + 1e-9);
      }
    }
    EXPECT_NEAR(road.PointAt(440.0).heading, 0.0, 1e-9) << "every second turn reverses the one before";
  }
}

TEST(ReferenceLine, TurnOfKnownGeometry) {
  // In a turn that is symmetric about its middle, the way in and the way out along the old and new direction are equal.
  const ReferenceLine road("turns", 100.0, 0.0, 5);
  const double at = road.junctions().front();
  const Eigen::Vector3d way = road.PointAt(at + 12.0).position - road.PointAt(at - 12.0).position;
  EXPECT_NEAR(std::abs(way.x()), way.z(), 1e-6);
  EXPECT_GT(way.z(), 12.0 * 2.0 / kPi);
  EXPECT_LT(way.z(), 24.0 / std::sqrt(2.0));
  // Each turn is taken only if it fits on the road with some way after it.
  EXPECT_TRUE(ReferenceLine("turns", 30.0, 0.0, 5).junctions().empty());
}

TEST(ReferenceLine, CurvesKeepTheirRadiiAndNeverTurnBack) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const ReferenceLine road("curved", 440.0, 0.0, seed);
    double sharpest = 0.0;
    for (double s = 0.0; s < 440.0; s += 0.5) {
      sharpest = std::max(sharpest, std::abs(road.PointAt(s).curvature));
      ASSERT_LE(std::abs(road.PointAt(s).heading), 1.0 + 1e-9);
      ASSERT_GT(road.PointAt(s + 0.5).position.z(), road.PointAt(s).position.z());
    }
    EXPECT_GE(sharpest, 1.0 / 300.0 - 1e-12);
    EXPECT_LE(sharpest, 1.0 / 60.0 + 1e-12);
    for (const double at : road.junctions()) EXPECT_NEAR(road.PointAt(at).curvature, 0.0, 1e-12);
  }
}

TEST(ReferenceLine, HillsStartLevelAndKeepTheirSlope) {
  double steepest = 0.0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const ReferenceLine road("straight", 440.0, 0.08, seed);
    EXPECT_EQ(road.PointAt(0.0).pitch, 0.0);
    for (double s = 0.0; s < 440.0; s += 0.5) {
      const double slope = std::abs(std::tan(road.PointAt(s).pitch));
      ASSERT_LE(slope, 0.08 + 1e-12);
      steepest = std::max(steepest, slope);
    }
  }
  EXPECT_GT(steepest, 0.06);
}

TEST(ReferenceLine, SameSeedSameRoadOtherSeedAnother) {
  const ReferenceLine a("curved", 300.0, 0.05, 9), b("curved", 300.0, 0.05, 9), c("curved", 300.0, 0.05, 10);
  EXPECT_EQ(a.PointAt(211.0).position, b.PointAt(211.0).position);
  EXPECT_EQ(a.junctions(), b.junctions());
  EXPECT_GT((a.PointAt(211.0).position - c.PointAt(211.0).position).norm(), 0.1);
}

TEST(ReferenceLine, RejectsUnknownShapesAndBadNumbers) {
  EXPECT_THROW(ReferenceLine("zigzag", 100.0, 0.0, 1), Error);
  EXPECT_THROW(ReferenceLine("straight", 0.0, 0.0, 1), Error);
  EXPECT_THROW(ReferenceLine("straight", std::nan(""), 0.0, 1), Error);
  EXPECT_THROW(ReferenceLine("straight", 100.0, 2.0, 1), Error);
}

}  // namespace
}  // namespace evo::simulation
