#include "tracking/motion/camera_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "evo/geometry/known_cameras.hpp"

namespace evo::tracking {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kShortestAway = 0.2;  // px/s
const Vector2d kFlow(120.0, -70.0);

/// Forwards, sideways and backwards.
std::vector<CameraMotion> Motions() {
  return {{Vector3d(0.05, -0.04, 1.0).normalized(), {0.05, -0.2, 0.1}},
          {Vector3d(1.0, 0.2, 0.1).normalized(), {-0.3, 0.0, 0.4}},
          {Vector3d(0.1, -0.3, -0.8).normalized(), {0.2, 0.1, -0.1}}};
}

std::vector<PixelGeometry> Pixels() {
  const LensGrid lens{geometry::Camera(geometry::MvsecDavis346())};
  std::vector<PixelGeometry> pixels;
  for (const Vector2d& pixel : {Vector2d(30, 20), Vector2d(200, 90), Vector2d(150, 220), Vector2d(320, 250)}) {
    pixels.push_back(lens.At(pixel));
  }
  return pixels;
}

FlowResidual Residual(const PixelGeometry& pixel, const CameraMotion& motion, const Vector2d& flow = kFlow,
                      double shortest_away = kShortestAway) {
  return ResidualOf(flow, pixel, motion, motion.DirectionTangents(), shortest_away);
}

TEST(CameraMotion, StepsAlongTangentsOfItsDirection) {
  for (const CameraMotion& motion : Motions()) {
    const CameraMotion::Tangents tangents = motion.DirectionTangents();
    EXPECT_TRUE((tangents.transpose() * tangents).isIdentity(1e-12));
    EXPECT_LT((tangents.transpose() * motion.direction).norm(), 1e-12);
    const CameraMotion::Step step(0.3, -0.4, 0.01, 0.02, 0.03);
    const CameraMotion moved = motion.Moved(tangents, step);
    EXPECT_NEAR(moved.direction.norm(), 1.0, 1e-12);
    EXPECT_NEAR(moved.direction.dot(motion.direction), 1.0 / std::hypot(1.0, 0.5), 1e-12);
    EXPECT_LT((moved.turn_rate - motion.turn_rate - Vector3d(0.01, 0.02, 0.03)).norm(), 1e-12);
  }
}

TEST(FlowResidual, IsWhatTheMotionDoesNotExplain) {
  for (const CameraMotion& motion : Motions()) {
    for (const PixelGeometry& pixel : Pixels()) {
      const Vector2d away = motion.Away(pixel);
      const Vector2d explained = pixel.by_rotation * motion.turn_rate + 0.7 * away;
      const Vector2d across = Vector2d(-away.y(), away.x()).normalized();
      EXPECT_NEAR(Residual(pixel, motion, explained).value, 0.0, 1e-9);
      EXPECT_NEAR(Residual(pixel, motion, explained + 3.0 * across).value, 3.0, 1e-9);
    }
  }
}

TEST(FlowResidual, HasTheDerivativeThatSmallStepsShow) {
  constexpr double kStep = 1e-5;
  for (const CameraMotion& motion : Motions()) {
    const CameraMotion::Tangents tangents = motion.DirectionTangents();
    for (const PixelGeometry& pixel : Pixels()) {
      const CameraMotion::Step derivative = Residual(pixel, motion).derivative;
      CameraMotion::Step numeric;
      for (int i = 0; i < numeric.size(); ++i) {
        const CameraMotion::Step step = kStep * CameraMotion::Step::Unit(i);
        const double after = Residual(pixel, motion.Moved(tangents, step)).value;
        const double before = Residual(pixel, motion.Moved(tangents, -step)).value;
        numeric[i] = (after - before) / (2.0 * kStep);
      }
      EXPECT_GT(derivative.head<2>().norm(), 0.1);
      EXPECT_LT((derivative - numeric).norm(), 1e-6 * derivative.norm())
          << derivative.transpose() << " is not " << numeric.transpose();
    }
  }
}

TEST(FlowResidual, FadesWhereTheLineMeansLittle) {
  const CameraMotion motion = Motions().front();
  const PixelGeometry pixel = Pixels().front();
  const FlowResidual sharp = Residual(pixel, motion);
  const FlowResidual faded = Residual(pixel, motion, kFlow, 10.0 * motion.Away(pixel).norm());
  EXPECT_NEAR(faded.value, 0.1 * sharp.value, 1e-9);
  EXPECT_LT(faded.derivative.norm(), 0.11 * sharp.derivative.norm());
}

}  // namespace
}  // namespace evo::tracking
