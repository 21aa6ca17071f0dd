#include "tracking/motion/ego_motion.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "evo/geometry/known_cameras.hpp"
#include "evo/geometry/se3.hpp"

namespace evo::tracking {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kStep = 1e-4;   // s, of numeric derivatives
constexpr double kFrame = 0.02;  // s

/// A camera with a `velocity` (m/s) while the world rotates about it with `angular_velocity` (rad/s).
struct Mover {
  geometry::Camera camera{geometry::MvsecDavis346()};
  Vector3d velocity{0.4, -0.3, 8.0};
  Vector3d angular_velocity{0.05, -0.2, 0.1};

  /// Pixel at `t` of a point in camera coordinates at time 0.
  Vector2d Seen(const Vector3d& point, double t) const {
    return camera.Project(geometry::so3::Exp(t * angular_velocity) * Vector3d(point - t * velocity));
  }
  FlowSample Sample(const Vector3d& point) const {
    return {Seen(point, 0.0), (Seen(point, kStep) - Seen(point, -kStep)) / (2.0 * kStep)};
  }
};

std::vector<FlowSample> Flows(const Mover& mover, int count, double noise_px_s, unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
  std::vector<FlowSample> samples;
  while (static_cast<int>(samples.size()) < count) {
    const double z = 5.0 + 30.0 * uniform();
    FlowSample sample = mover.Sample({z * (1.4 * uniform() - 0.7), z * (1.0 * uniform() - 0.5), z});
    if (!mover.camera.Contains(sample.position, 5.0)) continue;
    sample.flow += noise_px_s * Vector2d(uniform() - 0.5, uniform() - 0.5);
    samples.push_back(sample);
  }
  return samples;
}

double AngleDeg(const Vector3d& a, const Vector3d& b) { return std::atan2(a.cross(b).norm(), a.dot(b)) * 180.0 / M_PI; }

TEST(EgoMotion, FindsForwardAndSidewaysMotion) {
  for (const Vector3d& velocity : {Vector3d(0.4, -0.3, 8.0), Vector3d(3.0, 0.0, 0.2), Vector3d(0.0, -2.0, -1.0)}) {
    Mover mover;
    mover.velocity = velocity;
    EgoMotion motion(mover.camera);
    motion.Update(Flows(mover, 80, 0.0, 3), kFrame);
    ASSERT_TRUE(motion.known());
    EXPECT_LT(AngleDeg(motion.direction(), velocity), 0.5) << velocity.transpose();
    EXPECT_LT((motion.angular_velocity() - mover.angular_velocity).norm(), 0.005) << velocity.transpose();
  }
}

TEST(EgoMotion, WithstandsNoiseAndMovingObjects) {
  const Mover mover;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    auto samples = Flows(mover, 100, 6.0, seed);
    for (std::size_t i = 0; i < 20; ++i) samples[5 * i].flow += Vector2d(-60.0, 20.0);
    EgoMotion motion(mover.camera);
    motion.Update(samples, kFrame);
    ASSERT_TRUE(motion.known()) << seed;
    EXPECT_LT(AngleDeg(motion.direction(), mover.velocity), 3.0) << seed;
    EXPECT_LT((motion.angular_velocity() - mover.angular_velocity).norm(), 0.03) << seed;
  }
}

TEST(EgoMotion, IsUnknownWithTooFewOrContradictoryFlows) {
  const Mover mover;
  EgoMotion motion(mover.camera);
  motion.Update(Flows(mover, 5, 0.0, 1), kFrame);
  EXPECT_FALSE(motion.known());
  motion.Update(Flows(mover, 60, 400.0, 1), kFrame);
  EXPECT_FALSE(motion.known());
  const PatchFlow patch = motion.PredictPatchFlow({{100, 100}, {10, 20}}, {0.01, 0.0});
  EXPECT_TRUE(patch.linear_rate.isZero() && patch.quadratic_rate.isZero() && patch.acceleration.isZero());
  EXPECT_TRUE(motion.EstimateInverseDepthGradient({100, 100}, Matrix2d::Identity()).isZero());
}

TEST(EgoMotion, FollowsAChangeOfDirection) {
  Mover mover;
  EgoMotion motion(mover.camera);
  motion.Update(Flows(mover, 80, 2.0, 3), kFrame);
  mover.velocity = {4.0, 0.0, 0.3};
  motion.Update(Flows(mover, 80, 2.0, 3), kFrame);
  ASSERT_TRUE(motion.known());
  EXPECT_LT(AngleDeg(motion.direction(), mover.velocity), 2.0);
}

TEST(EgoMotion, LearnsTheTypicalAngularAcceleration) {
  const auto change_after = [](double swing) {
    Mover mover;
    EgoMotion motion(mover.camera);
    const Vector3d mean = mover.angular_velocity;
    for (int i = 0; i < 50; ++i) {
      mover.angular_velocity = mean + Vector3d(swing * std::sin(0.5 * i), 0.0, 0.0);
      motion.Update(Flows(mover, 80, 0.0, 3), kFrame);
    }
    return motion.typical_angular_acceleration();
  };
  EXPECT_LT(change_after(0.0), 0.01);
  const double mean_change = 0.2 * 0.5 * M_2_PI / kFrame;  // of a sine, from frame to frame
  EXPECT_NEAR(change_after(0.2), mean_change, 0.4 * mean_change);
}

TEST(EgoMotion, IsUnknownWhereTheCameraStandsOrOnlyRotates) {
  Mover mover;
  mover.velocity.setZero();
  EgoMotion motion(mover.camera);
  motion.Update(Flows(mover, 80, 0.5, 3), kFrame);
  EXPECT_FALSE(motion.known());
  mover.angular_velocity.setZero();
  motion.Update(Flows(mover, 80, 0.5, 3), kFrame);
  EXPECT_FALSE(motion.known());
}

TEST(EgoMotion, IgnoresPixelsWhereTheLensHasNoInverse) {
  // The barrel distortion is so strong that the corners of the image lie outside the model.
  geometry::Calibration calibration = geometry::MvsecDavis346();
  calibration.distortion = geometry::Distortion::kRadTan;
  calibration.coefficients = {-0.45, 0.0, 0.0, 0.0, 0.0};
  Mover mover;
  mover.camera = geometry::Camera(calibration);
  ASSERT_FALSE(mover.camera.Undistort({2, 2}));
  EgoMotion motion(mover.camera);
  auto samples = Flows(mover, 80, 0.0, 3);
  samples.push_back({{2, 2}, {-100, -80}});
  motion.Update(samples, kFrame);
  ASSERT_TRUE(motion.known());
  for (const Vector2d& pixel : {Vector2d(2, 2), Vector2d(-3, -3), Vector2d(360, 270), Vector2d(173, 130)}) {
    const PatchFlow patch = motion.PredictPatchFlow({pixel, {100, 80}}, {0.01, 0.0});
    EXPECT_TRUE(patch.linear_rate.allFinite() && patch.quadratic_rate.allFinite() && patch.acceleration.allFinite());
    EXPECT_LT(patch.linear_rate.norm(), 20.0) << pixel.transpose();
    EXPECT_TRUE(motion.EstimateInverseDepthGradient(pixel, Matrix2d::Identity()).allFinite());
    motion.MayBeStatic({pixel, {100, 80}});
  }
}

TEST(EgoMotion, MayBeStaticTellsMovingObjects) {
  Mover mover;
  mover.angular_velocity.setZero();
  EgoMotion motion(mover.camera);
  const FlowSample is_static = mover.Sample({1.0, 0.8, 6.0});
  const FlowSample backwards{is_static.position, -is_static.flow};
  const FlowSample across{is_static.position, {-is_static.flow.y(), is_static.flow.x()}};
  EXPECT_TRUE(motion.MayBeStatic(backwards));  // nothing is known yet
  motion.Update(Flows(mover, 80, 0.0, 3), kFrame);
  EXPECT_TRUE(motion.MayBeStatic(is_static));
  EXPECT_FALSE(motion.MayBeStatic(backwards));
  EXPECT_FALSE(motion.MayBeStatic(across));
}

TEST(EgoMotion, PredictsThePatchFlowOfARoad) {
  const Mover mover;
  EgoMotion motion(mover.camera);
  motion.Update(Flows(mover, 80, 0.0, 3), kFrame);
  ASSERT_TRUE(motion.known());
  // The inverse depth of the road, y = 1.5 m, is y / 1.5 on the plane z = 1.
  constexpr double kHeight = 1.5;
  const auto on_road = [&](const Vector2d& pixel) {
    const auto x = mover.camera.Undistort(pixel);
    return Vector3d(kHeight / x->y() * Vector3d(x->x(), x->y(), 1.0));
  };
  const Vector2d centre(120, 190);
  const FlowSample sample = mover.Sample(on_road(centre));
  const double speed = mover.velocity.norm();
  const Vector2d gradient(0.0, speed / kHeight / mover.camera.calibration().fy);
  const PatchFlow patch = motion.PredictPatchFlow(sample, gradient);
  for (const Vector2d& y : {Vector2d(6, 0), Vector2d(0, 6), Vector2d(-5, -5), Vector2d(4, -6)}) {
    const Vector2d expected = mover.Sample(on_road(centre + y)).flow - sample.flow;
    const Vector2d predicted = patch.linear_rate * y + patch.quadratic_rate.dot(y) * y;
    EXPECT_LT((predicted - expected).norm(), 0.15 * expected.norm() + 0.3) << y.transpose();
  }
  // The residual rate of a patch assumed to face the camera determines the gradient.
  const Matrix2d residual_rate = patch.linear_rate - motion.PredictPatchFlow(sample, Vector2d::Zero()).linear_rate;
  EXPECT_LT((motion.EstimateInverseDepthGradient(sample.position, residual_rate) - gradient).norm(),
            0.1 * gradient.norm());
}

TEST(EgoMotion, PredictsTheAccelerationOfAPoint) {
  Mover mover;
  mover.angular_velocity.setZero();
  EgoMotion motion(mover.camera);
  motion.Update(Flows(mover, 80, 0.0, 3), kFrame);
  ASSERT_TRUE(motion.known());
  // Near the edge the lens lets the flow grow less.
  for (const Vector2d& pixel : {Vector2d(120, 190), Vector2d(30, 235), Vector2d(325, 130), Vector2d(300, 20)}) {
    const Vector3d point = 6.0 * mover.camera.Undistort(pixel)->homogeneous();
    const FlowSample sample = mover.Sample(point);
    constexpr double kLater = 0.02;
    const Vector2d expected =
        (mover.Seen(point, kLater) - 2.0 * mover.Seen(point, 0.0) + mover.Seen(point, -kLater)) / (kLater * kLater);
    // The acceleration of the centre does not depend on the gradient.
    for (const Vector2d& gradient : {Vector2d(0.0, 0.0), Vector2d(0.01, 0.02)}) {
      const Vector2d acceleration = motion.PredictPatchFlow(sample, gradient).acceleration;
      EXPECT_LT((acceleration - expected).norm(), 0.08 * expected.norm()) << pixel.transpose();
    }
  }
}

TEST(EgoMotion, IsFilteredFromFrameToFrame) {
  const Mover mover;
  EgoMotion filtered(mover.camera);
  double error = 0.0, error_alone = 0.0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const auto samples = Flows(mover, 80, 10.0, seed);
    EgoMotion alone(mover.camera);
    alone.Update(samples, kFrame);
    filtered.Update(samples, kFrame);
    ASSERT_TRUE(alone.known() && filtered.known()) << seed;
    if (seed <= 5) continue;
    error += AngleDeg(filtered.direction(), mover.velocity);
    error_alone += AngleDeg(alone.direction(), mover.velocity);
  }
  EXPECT_LT(error, 0.7 * error_alone);
}

TEST(EgoMotion, PatchFlowAgreesWithNumericDerivatives) {
  // Without distortion the flow of a plane is a polynomial of second degree, so its differences are exact.
  geometry::Calibration calibration = geometry::MvsecDavis346();
  calibration.distortion = geometry::Distortion::kRadTan;
  calibration.coefficients = {};
  calibration.fy = calibration.fx;
  Mover mover;
  mover.camera = geometry::Camera(calibration);
  EgoMotion motion(mover.camera);
  motion.Update(Flows(mover, 80, 0.0, 3), kFrame);
  ASSERT_TRUE(motion.known());
  const Vector2d gradient(0.004, 0.01);
  for (const Vector2d& centre : {Vector2d(120, 190), Vector2d(60, 60), Vector2d(280, 100)}) {
    const FlowSample sample = mover.Sample(6.0 * mover.camera.Undistort(centre)->homogeneous());
    const PatchFlow patch = motion.PredictPatchFlow(sample, gradient);
    const double inverse_depth = motion.EstimateInverseDepth(sample);
    // Of planes through the same point, with the gradient and without.
    const auto tilted = [&](const Vector2d& y) {
      return motion.PredictFlow(centre + y, inverse_depth + gradient.dot(y));
    };
    const auto parallel = [&](const Vector2d& y) { return motion.PredictFlow(centre + y, inverse_depth); };
    constexpr double kDifference = 1.0;  // px
    for (int axis = 0; axis < 2; ++axis) {
      const Vector2d y = kDifference * Vector2d::Unit(axis);
      const Vector2d first = (tilted(y) - tilted(-y)) / (2.0 * kDifference);
      EXPECT_LT((patch.linear_rate.col(axis) - first).norm(), 1e-4) << centre.transpose();
      const Vector2d second = 0.5 * (tilted(y) + tilted(-y) - parallel(y) - parallel(-y));
      EXPECT_LT((patch.quadratic_rate.dot(y) * y - second).norm(), 1e-5) << centre.transpose();
    }
  }
}

TEST(EgoMotion, ProjectsTheFlowOfAStaticPointToItsLine) {
  Mover mover;
  mover.angular_velocity.setZero();
  EgoMotion motion(mover.camera);
  const FlowSample truth = mover.Sample({2.5, 1.5, 6.0});
  const Vector2d along = truth.flow.normalized(), across(-along.y(), along.x());
  const FlowSample off{truth.position, truth.flow + 3.0 * across};
  EXPECT_EQ(motion.ProjectToEpipolarLine(off), off.flow);  // nothing is known yet
  motion.Update(Flows(mover, 80, 0.0, 3), kFrame);
  ASSERT_TRUE(motion.known());
  EXPECT_LT((motion.ProjectToEpipolarLine(off) - truth.flow).norm(), 1.5);
  // The flow along the line is kept, and so is that of a moving object.
  const FlowSample faster{truth.position, truth.flow + 3.0 * along};
  EXPECT_LT((motion.ProjectToEpipolarLine(faster) - faster.flow).norm(), 0.5);
  const FlowSample moving{truth.position, truth.flow + 300.0 * across};
  EXPECT_LT((motion.ProjectToEpipolarLine(moving) - moving.flow).norm(), 10.0);
}

TEST(EgoMotion, EstimatesAndPropagatesInverseDepths) {
  const Mover mover;
  EgoMotion motion(mover.camera);
  const Vector3d point(2.5, 1.5, 6.0);
  EXPECT_EQ(motion.EstimateInverseDepth(mover.Sample(point)), 0.0);  // nothing is known yet
  motion.Update(Flows(mover, 80, 0.0, 3), kFrame);
  const double speed = mover.velocity.norm();
  const double inverse_depth = motion.EstimateInverseDepth(mover.Sample(point));
  EXPECT_NEAR(inverse_depth, speed / point.z(), 0.04 * speed / point.z());
  constexpr double kLater = 0.05;
  const double growth = point.z() / (point.z() - kLater * mover.velocity.z());
  EXPECT_NEAR(motion.PropagateInverseDepth(inverse_depth, kLater), growth * inverse_depth, 0.01 * inverse_depth);
}

}  // namespace
}  // namespace evo::tracking
