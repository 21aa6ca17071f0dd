#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "evo/core/error.hpp"
#include "simulation/motion/vehicle_motion.hpp"

namespace evo::simulation {
namespace {

constexpr double kPi = std::numbers::pi;

Eigen::Vector3d Direction(const ReferenceLine::Point& point) {
  return {std::cos(point.pitch) * std::sin(point.heading), -std::sin(point.pitch),
          std::cos(point.pitch) * std::cos(point.heading)};
}

/// Position, heading and curvature agree with one another all along the line and beyond its ends.
void ExpectConsistent(const ReferenceLine& road) {
  constexpr double kStep = 0.01;
  for (double s = -20.0; s < road.length() + 150.0; s += 0.0371) {
    const auto before = road.At(s - kStep), at = road.At(s), after = road.At(s + kStep);
    const Eigen::Vector3d slope = (after.position - before.position) / (2.0 * kStep);
    ASSERT_LT((slope - Direction(at)).norm(), 2e-5) << "at " << s;
    ASSERT_NEAR((after.heading - before.heading) / (2.0 * kStep), at.curvature, 3e-4) << "at " << s;
    ASSERT_LT(std::abs(after.curvature - before.curvature), 2.0 * kStep * 0.025) << "at " << s;
    ASSERT_LE(std::abs(at.curvature), 1.0 / 8.0 + 1e-12);
  }
}

TEST(ReferenceLine, StraightRoadFollowsZ) {
  const ReferenceLine road("straight", 440.0, 0.0, 3);
  EXPECT_LT((road.At(123.4).position - Eigen::Vector3d(0.0, 0.0, 123.4)).norm(), 1e-9);
  EXPECT_LT((road.At(-10.0).position - Eigen::Vector3d(0.0, 0.0, -10.0)).norm(), 1e-9);
  EXPECT_LT((road.At(500.0).position - Eigen::Vector3d(0.0, 0.0, 500.0)).norm(), 1e-9);
  EXPECT_EQ(road.At(77.0).heading, 0.0);
  ASSERT_GE(road.crossings().size(), 3U);
  for (const double at : road.crossings()) EXPECT_TRUE(at > 0.0 && at <= 440.0);
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

TEST(ReferenceLine, TurnsAreFourRightAnglesAtCrossings) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const ReferenceLine road("turns", 440.0, 0.0, seed);
    ASSERT_EQ(road.crossings().size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) {
      const double at = road.crossings()[i];
      const double before = road.At(at - 12.0).heading, after = road.At(at + 12.0).heading;
      EXPECT_NEAR(std::abs(after - before), 0.5 * kPi, 1e-9);
      EXPECT_NEAR(road.At(at).heading, 0.5 * (before + after), 1e-9) << "the middle of the turn";
      EXPECT_NEAR(std::abs(road.At(at).curvature), 1.0 / 8.0, 1e-12);
      if (i > 0) {
        EXPECT_NEAR(at - road.crossings()[i - 1], 80.0, 5.0 + 1e-9);
      }
    }
    EXPECT_NEAR(road.At(440.0).heading, 0.0, 1e-9) << "each second turn undoes the one before";
  }
}

TEST(ReferenceLine, TurnOfKnownGeometry) {
  // In a turn that is symmetric about its middle, the way in and the way out along the old and new direction are equal.
  const ReferenceLine road("turns", 100.0, 0.0, 5);
  const double at = road.crossings().front();
  const Eigen::Vector3d way = road.At(at + 12.0).position - road.At(at - 12.0).position;
  EXPECT_NEAR(std::abs(way.x()), way.z(), 1e-6);
  EXPECT_GT(way.z(), 12.0 * 2.0 / kPi);
  EXPECT_LT(way.z(), 24.0 / std::sqrt(2.0));
  // Each turn is taken only if it fits on the road with some way after it.
  EXPECT_TRUE(ReferenceLine("turns", 30.0, 0.0, 5).crossings().empty());
}

TEST(ReferenceLine, CurvesBendWithinTheirRadiiAndDoNotComeBack) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const ReferenceLine road("curved", 440.0, 0.0, seed);
    double sharpest = 0.0;
    for (double s = 0.0; s < 440.0; s += 0.5) {
      sharpest = std::max(sharpest, std::abs(road.At(s).curvature));
      ASSERT_LE(std::abs(road.At(s).heading), 1.0 + 1e-9);
      ASSERT_GT(road.At(s + 0.5).position.z(), road.At(s).position.z());
    }
    EXPECT_GE(sharpest, 1.0 / 300.0 - 1e-12);
    EXPECT_LE(sharpest, 1.0 / 60.0 + 1e-12);
    for (const double at : road.crossings()) EXPECT_NEAR(road.At(at).curvature, 0.0, 1e-12);
  }
}

TEST(ReferenceLine, HillsStartLevelAndKeepTheirSlope) {
  double steepest = 0.0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const ReferenceLine road("straight", 440.0, 0.08, seed);
    EXPECT_EQ(road.At(0.0).pitch, 0.0);
    for (double s = 0.0; s < 440.0; s += 0.5) {
      const double slope = std::abs(std::tan(road.At(s).pitch));
      ASSERT_LE(slope, 0.08 + 1e-12);
      steepest = std::max(steepest, slope);
    }
  }
  EXPECT_GT(steepest, 0.06);
}

TEST(ReferenceLine, SameSeedSameRoadOtherSeedAnother) {
  const ReferenceLine a("curved", 300.0, 0.05, 9), b("curved", 300.0, 0.05, 9), c("curved", 300.0, 0.05, 10);
  EXPECT_EQ(a.At(211.0).position, b.At(211.0).position);
  EXPECT_EQ(a.crossings(), b.crossings());
  EXPECT_GT((a.At(211.0).position - c.At(211.0).position).norm(), 0.1);
}

TEST(ReferenceLine, RefusesNonsense) {
  EXPECT_THROW(ReferenceLine("zigzag", 100.0, 0.0, 1), Error);
  EXPECT_THROW(ReferenceLine("straight", 0.0, 0.0, 1), Error);
  EXPECT_THROW(ReferenceLine("straight", std::nan(""), 0.0, 1), Error);
  EXPECT_THROW(ReferenceLine("straight", 100.0, 2.0, 1), Error);
}

}  // namespace
}  // namespace evo::simulation
