#include "tracking/motion/camera_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "evo/geometry/known_cameras.hpp"
#include "evo/geometry/se3.hpp"

namespace evo::tracking {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kMinTranslationalFlow = 0.2;  // px/s
const Vector2d kFlow(120.0, -70.0);

/// Forwards, sideways and backwards.
std::vector<CameraMotion> Motions() {
  return {{Vector3d(0.05, -0.04, 1.0).normalized(), {0.05, -0.2, 0.1}},
          {Vector3d(1.0, 0.2, 0.1).normalized(), {-0.3, 0.0, 0.4}},
          {Vector3d(0.1, -0.3, -0.8).normalized(), {0.2, 0.1, -0.1}}};
}

std::vector<PixelJacobians> Pixels() {
  const JacobianTable jacobians{geometry::Camera(geometry::MvsecDavis346())};
  std::vector<PixelJacobians> pixels;
  for (const Vector2d& pixel : {Vector2d(30, 20), Vector2d(200, 90), Vector2d(150, 220), Vector2d(320, 250)}) {
    pixels.push_back(jacobians.Lookup(pixel));
  }
  return pixels;
}

EpipolarResidual Residual(const PixelJacobians& pixel, const CameraMotion& motion, const Vector2d& flow = kFlow,
                          double min_translational_flow = kMinTranslationalFlow) {
  return ComputeEpipolarResidual(flow, pixel, motion, motion.DirectionTangents(), min_translational_flow);
}

TEST(CameraMotion, RetractsAlongTheTangentsOfItsDirection) {
  for (const CameraMotion& motion : Motions()) {
    const CameraMotion::Tangents tangents = motion.DirectionTangents();
    EXPECT_TRUE((tangents.transpose() * tangents).isIdentity(1e-12));
    EXPECT_LT((tangents.transpose() * motion.direction).norm(), 1e-12);
    const CameraMotion::Step step(0.3, -0.4, 0.01, 0.02, 0.03);
    const CameraMotion retracted = motion.Retract(tangents, step);
    EXPECT_NEAR(retracted.direction.norm(), 1.0, 1e-12);
    EXPECT_NEAR(retracted.direction.dot(motion.direction), 1.0 / std::hypot(1.0, 0.5), 1e-12);
    EXPECT_LT((retracted.angular_velocity - motion.angular_velocity - Vector3d(0.01, 0.02, 0.03)).norm(), 1e-12);
  }
}

TEST(CameraMotion, DirectionJacobianAgreesWithTheNumericOne) {
  constexpr double kStep = 1e-6;
  for (const CameraMotion& motion : Motions()) {
    for (const PixelJacobians& pixel : Pixels()) {
      const Eigen::Matrix<double, 2, 3> J_flow_direction =
          pixel.J_pixel_normalized * CameraMotion::DirectionJacobian(pixel);
      for (int axis = 0; axis < 3; ++axis) {
        CameraMotion after = motion, before = motion;
        after.direction[axis] += kStep;
        before.direction[axis] -= kStep;
        const Vector2d numeric = (after.TranslationalFlow(pixel) - before.TranslationalFlow(pixel)) / (2.0 * kStep);
        EXPECT_LT((J_flow_direction.col(axis) - numeric).norm(), 1e-4) << axis;
      }
    }
  }
}

TEST(CameraMotion, PredictedFlowIsThatOfAMovingPoint) {
  constexpr double kStep = 1e-4;  // s
  const geometry::Camera camera(geometry::MvsecDavis346());
  const JacobianTable jacobians(camera);
  for (const CameraMotion& motion : Motions()) {
    for (const Vector2d& pixel : {Vector2d(32, 20), Vector2d(200, 92), Vector2d(320, 248)}) {
      const Vector3d point = 4.0 * camera.Undistort(pixel)->homogeneous();
      const auto seen = [&](double t) {
        return camera.Project(geometry::so3::Exp(t * motion.angular_velocity) * Vector3d(point - t * motion.direction));
      };
      const Vector2d numeric = (seen(kStep) - seen(-kStep)) / (2.0 * kStep);
      const Vector2d flow = motion.PredictFlow(jacobians.Lookup(pixel), 0.25);
      EXPECT_LT((flow - numeric).norm(), 1e-3 * numeric.norm()) << pixel.transpose();
    }
  }
}

TEST(EpipolarResidual, IsTheDistanceFromTheLine) {
  for (const CameraMotion& motion : Motions()) {
    for (const PixelJacobians& pixel : Pixels()) {
      const Vector2d line = motion.TranslationalFlow(pixel);
      const Vector2d explained = pixel.J_pixel_rotation * motion.angular_velocity + 0.7 * line;
      const Vector2d across = Vector2d(-line.y(), line.x()).normalized();
      EXPECT_NEAR(Residual(pixel, motion, explained).value, 0.0, 1e-9);
      EXPECT_NEAR(Residual(pixel, motion, explained + 3.0 * across).value, 3.0, 1e-9);
    }
  }
}

TEST(EpipolarResidual, JacobianAgreesWithTheNumericOne) {
  constexpr double kStep = 1e-5;
  for (const CameraMotion& motion : Motions()) {
    const CameraMotion::Tangents tangents = motion.DirectionTangents();
    for (const PixelJacobians& pixel : Pixels()) {
      const CameraMotion::Step jacobian = Residual(pixel, motion).jacobian;
      CameraMotion::Step numeric;
      for (int i = 0; i < numeric.size(); ++i) {
        const CameraMotion::Step step = kStep * CameraMotion::Step::Unit(i);
        const double after = Residual(pixel, motion.Retract(tangents, step)).value;
        const double before = Residual(pixel, motion.Retract(tangents, -step)).value;
        numeric[i] = (after - before) / (2.0 * kStep);
      }
      EXPECT_GT(jacobian.head<2>().norm(), 0.1);
      EXPECT_LT((jacobian - numeric).norm(), 1e-6 * jacobian.norm())
          << jacobian.transpose() << " is not " << numeric.transpose();
    }
  }
}

TEST(EpipolarResidual, FadesWhereTheLineIsIllDefined) {
  const CameraMotion motion = Motions().front();
  const PixelJacobians pixel = Pixels().front();
  const EpipolarResidual sharp = Residual(pixel, motion);
  const EpipolarResidual faded = Residual(pixel, motion, kFlow, 10.0 * motion.TranslationalFlow(pixel).norm());
  EXPECT_NEAR(faded.value, 0.1 * sharp.value, 1e-9);
  EXPECT_LT(faded.jacobian.norm(), 0.11 * sharp.jacobian.norm());
}

}  // namespace
}  // namespace evo::tracking
