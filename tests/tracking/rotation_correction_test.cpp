#include "tracking/motion/rotation_correction.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "evo/geometry/known_cameras.hpp"
#include "tracking/motion/jacobian_table.hpp"

namespace evo::tracking {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

const Vector3d kRotation(0.02, -0.005, 0.01);     // rad
const Vector3d kAngularVelocity(0.5, -0.1, 0.3);  // rad/s

std::vector<PredictionResidual> Residuals(const JacobianTable& jacobians, int count, double noise_px, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto noise = [&]() -> Vector2d { return noise_px * Vector2d(uniform(random), uniform(random)); };
  std::vector<PredictionResidual> residuals;
  for (int i = 0; i < count; ++i) {
    const Vector2d position(173.0 + 150.0 * uniform(random), 130.0 + 110.0 * uniform(random));
    const auto& J_pixel_rotation = jacobians.Lookup(position).J_pixel_rotation;
    residuals.push_back({J_pixel_rotation, J_pixel_rotation * kRotation + noise(),
                         J_pixel_rotation * kAngularVelocity + 20.0 * noise()});
  }
  return residuals;
}

TEST(RotationCorrection, IsTheRotationThatAllFeaturesShare) {
  const JacobianTable jacobians{geometry::Camera(geometry::MvsecDavis346())};
  const auto residuals = Residuals(jacobians, 60, 0.0, 1);
  const RotationCorrection correction = EstimateRotationCorrection(residuals);
  EXPECT_LT((correction.rotation - kRotation).norm(), 1e-4);
  EXPECT_LT((correction.angular_velocity - kAngularVelocity).norm(), 1e-3);
  double squares = 0.0;
  for (const auto& residual : residuals) squares += residual.offset.squaredNorm();
  EXPECT_NEAR(correction.rms_motion_px, std::sqrt(squares / 60.0), 0.01);
}

TEST(RotationCorrection, WithstandsNoiseAndOutliers) {
  const JacobianTable jacobians{geometry::Camera(geometry::MvsecDavis346())};
  for (unsigned seed = 1; seed <= 5; ++seed) {
    auto residuals = Residuals(jacobians, 100, 0.5, seed);
    for (std::size_t i = 0; i < 20; ++i) residuals[5 * i].offset = Vector2d(6.0, 0.0);
    for (std::size_t i = 0; i < 20; ++i) residuals[5 * i].flow = Vector2d(-200.0, 100.0);
    const RotationCorrection correction = EstimateRotationCorrection(residuals);
    EXPECT_LT((correction.rotation - kRotation).norm(), 0.003) << seed;
    EXPECT_LT((correction.angular_velocity - kAngularVelocity).norm(), 0.06) << seed;
  }
}

TEST(RotationCorrection, IsZeroWithTooFewFeatures) {
  const JacobianTable jacobians{geometry::Camera(geometry::MvsecDavis346())};
  const RotationCorrection correction = EstimateRotationCorrection(Residuals(jacobians, 8, 0.0, 1));
  EXPECT_EQ(correction.rms_motion_px, 0.0);
  EXPECT_TRUE(correction.rotation.isZero(0.0));
  EXPECT_TRUE(correction.angular_velocity.isZero(0.0));
}

}  // namespace
}  // namespace evo::tracking
