#include "tracking/motion/jolt.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "evo/geometry/known_cameras.hpp"
#include "tracking/motion/lens_grid.hpp"

namespace evo::tracking {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

const Vector3d kTurn(0.02, -0.005, 0.01);  // rad
const Vector3d kTurnRate(0.5, -0.1, 0.3);  // rad/s

std::vector<UnexpectedMotion> Motions(const LensGrid& lens, int count, double noise_px, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto noise = [&]() -> Vector2d { return noise_px * Vector2d(uniform(random), uniform(random)); };
  std::vector<UnexpectedMotion> motions;
  for (int i = 0; i < count; ++i) {
    const Vector2d position(173.0 + 150.0 * uniform(random), 130.0 + 110.0 * uniform(random));
    const auto& by_rotation = lens.At(position).by_rotation;
    motions.push_back({by_rotation, by_rotation * kTurn + noise(), by_rotation * kTurnRate + 20.0 * noise()});
  }
  return motions;
}

TEST(Jolt, IsTheTurnThatAllShare) {
  const LensGrid lens{geometry::Camera(geometry::MvsecDavis346())};
  const auto motions = Motions(lens, 60, 0.0, 1);
  const Jolt jolt = FindJolt(motions);
  EXPECT_LT((jolt.turn - kTurn).norm(), 1e-4);
  EXPECT_LT((jolt.turn_rate - kTurnRate).norm(), 1e-3);
  double squares = 0.0;
  for (const auto& motion : motions) squares += motion.offset.squaredNorm();
  EXPECT_NEAR(jolt.motion_px, std::sqrt(squares / 60.0), 0.01);
}

TEST(Jolt, WithstandsNoiseAndFeaturesThatWentAstray) {
  const LensGrid lens{geometry::Camera(geometry::MvsecDavis346())};
  for (unsigned seed = 1; seed <= 5; ++seed) {
    auto motions = Motions(lens, 100, 0.5, seed);
    for (std::size_t i = 0; i < 20; ++i) motions[5 * i].offset = Vector2d(6.0, 0.0);
    for (std::size_t i = 0; i < 20; ++i) motions[5 * i].flow = Vector2d(-200.0, 100.0);
    const Jolt jolt = FindJolt(motions);
    EXPECT_LT((jolt.turn - kTurn).norm(), 0.003) << seed;
    EXPECT_LT((jolt.turn_rate - kTurnRate).norm(), 0.06) << seed;
  }
}

TEST(Jolt, IsNoneWithTooFewFeatures) {
  const LensGrid lens{geometry::Camera(geometry::MvsecDavis346())};
  const Jolt jolt = FindJolt(Motions(lens, 8, 0.0, 1));
  EXPECT_EQ(jolt.motion_px, 0.0);
  EXPECT_TRUE(jolt.turn.isZero(0.0));
  EXPECT_TRUE(jolt.turn_rate.isZero(0.0));
}

}  // namespace
}  // namespace evo::tracking
