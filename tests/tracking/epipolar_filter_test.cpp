#include "tracking/motion/epipolar_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "evo/core/median.hpp"
#include "evo/geometry/known_cameras.hpp"
#include "evo/geometry/se3.hpp"

namespace evo::tracking {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kStepS = 0.02;
constexpr double kNoisePx = 0.15;

/// Errors of noisy positions after 30 frames, raw and filtered, px.
struct Errors {
  std::vector<double> across_raw, across, along_raw, along;
};

/// A camera passes static points at 1 unit/s with random rotations; its direction in frame k is heading(k). The filter
/// gets a constant direction, straight ahead.
class Drive {
 public:
  Drive(int points, unsigned seed) : random_(seed) {
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (int i = 0; i < points; ++i) {
      const double z = 3.0 + 4.0 * std::abs(uniform(random_));
      points_.emplace_back(0.5 * z * uniform(random_), 0.35 * z * uniform(random_), z);
    }
  }

  Errors Run(const std::function<Vector3d(int)>& heading) {
    std::normal_distribution<double> normal;
    EpipolarFilter filter;
    Errors errors;
    std::vector<Vector2d> filtered;
    for (int k = 0; k <= 30; ++k) {
      const Vector3d rotation(0.004 * normal(random_), 0.004 * normal(random_) + 0.002, 0.004 * normal(random_));
      if (k > 0) {
        for (auto& point : points_) point = geometry::so3::Exp(rotation) * (point - kStepS * heading(k).normalized());
      }
      std::vector<FeatureStep> steps;
      std::vector<Vector2d> truth, noisy;
      for (std::size_t i = 0; i < points_.size(); ++i) {
        truth.push_back(camera_.Project(points_[i]));
        noisy.push_back(truth.back() + kNoisePx * Vector2d(normal(random_), normal(random_)));
        steps.push_back({k > 0 ? filtered[i] : noisy.back(), noisy.back(), 1.0 / points_[i].z()});
      }
      if (k == 0) {
        filtered = truth;
        continue;
      }
      filtered = filter.Filter({Vector3d::UnitZ(), Vector3d::Zero()}, jacobians_, kStepS, steps);
      if (k < 30) continue;
      for (std::size_t i = 0; i < points_.size(); ++i) {
        const Vector2d line = (camera_.Project(points_[i] - 0.01 * heading(k)) - truth[i]).normalized();
        const Vector2d normal_of_line(-line.y(), line.x());
        errors.across_raw.push_back(std::abs(normal_of_line.dot(noisy[i] - truth[i])));
        errors.across.push_back(std::abs(normal_of_line.dot(filtered[i] - truth[i])));
        errors.along_raw.push_back(std::abs(line.dot(noisy[i] - truth[i])));
        errors.along.push_back(std::abs(line.dot(filtered[i] - truth[i])));
      }
    }
    return errors;
  }

 private:
  geometry::Camera camera_{geometry::MvsecDavis346()};
  JacobianTable jacobians_{camera_};
  std::mt19937 random_;
  std::vector<Vector3d> points_;
};

TEST(EpipolarDeviation, JacobianAgreesWithTheNumericOne) {
  constexpr double kDifference = 1e-4;
  const geometry::Camera camera(geometry::MvsecDavis346());
  const JacobianTable jacobians(camera);
  const CameraMotion motion{Vector3d(0.2, -0.1, 1.0).normalized(), Vector3d::Zero()};
  const CameraMotion::Tangents tangents = motion.DirectionTangents();
  for (const Vector3d& point : {Vector3d(1.0, 0.8, 3.0), Vector3d(-1.5, 0.5, 4.0), Vector3d(0.3, -1.0, 2.5)}) {
    // Position after a step with a correction of the rotation and the direction.
    const auto seen = [&](const EpipolarDeviation::Correction& correction) {
      const Vector3d translation = kStepS * (motion.direction + tangents * correction.tail<2>());
      return camera.Project(geometry::so3::Exp(correction.head<3>()) * Vector3d(point - translation));
    };
    const FeatureStep step{camera.Project(point), seen(EpipolarDeviation::Correction::Zero()), 1.0 / point.z()};
    const EpipolarDeviation deviation = ComputeEpipolarDeviation(motion, tangents, jacobians, kStepS, step);
    ASSERT_TRUE(deviation.observable());
    for (int i = 0; i < 5; ++i) {
      const EpipolarDeviation::Correction difference = kDifference * EpipolarDeviation::Correction::Unit(i);
      const double numeric = deviation.normal.dot(seen(difference) - seen(-difference)) / (2.0 * kDifference);
      EXPECT_NEAR(deviation.jacobian[i], numeric, 0.02 * deviation.jacobian.norm()) << i;
    }
    EXPECT_NEAR(deviation.value, 0.0, 0.02);  // a static point moves along its line
    EXPECT_NEAR(deviation.baseline_px, (step.measured - step.previous).norm(), 0.02 * deviation.baseline_px);
  }
}

TEST(EpipolarFilter, ReducesErrorsAcrossTheLines) {
  const Errors errors = Drive(120, 1).Run([](int) { return Vector3d::UnitZ(); });
  EXPECT_LT(Median(errors.across), 0.6 * Median(errors.across_raw));
  EXPECT_NEAR(Median(errors.along), Median(errors.along_raw), 0.2 * Median(errors.along_raw));
}

TEST(EpipolarFilter, AWrongDirectionDoesNotMoveAllFeatures) {
  // 3 degrees off all the time: what all features share is no error of theirs.
  const Errors errors = Drive(120, 2).Run([](int) { return Vector3d(0.05, 0.0, 1.0); });
  EXPECT_LT(Median(errors.across), 0.8 * Median(errors.across_raw));
}

TEST(EpipolarFilter, LeavesAHandHeldCameraAlone) {
  const auto heading = [](int k) { return Vector3d(std::sin(0.9 * k), std::cos(1.3 * k), 1.0); };
  const Errors errors = Drive(120, 3).Run(heading);
  EXPECT_LT(Median(errors.across), 1.3 * Median(errors.across_raw));
}

TEST(EpipolarFilter, AMovingObjectKeepsItsPosition) {
  const geometry::Camera camera(geometry::MvsecDavis346());
  const JacobianTable jacobians(camera);
  std::vector<FeatureStep> steps;
  for (int i = 0; i < 60; ++i) {
    const Vector3d point(std::sin(1.0 * i), 0.6 * std::cos(1.7 * i), 2.5);
    steps.push_back({camera.Project(point), camera.Project(point - Vector3d(0.0, 0.0, kStepS)), 1.0 / 2.5});
  }
  steps[7].measured += Vector2d(6.0, -5.0);
  EpipolarFilter filter;
  const auto positions = filter.Filter({Vector3d::UnitZ(), Vector3d::Zero()}, jacobians, kStepS, steps);
  EXPECT_LT((positions[7] - steps[7].measured).norm(), 0.5);
  EXPECT_LT((positions[8] - steps[8].measured).norm(), 0.1);
}

TEST(EpipolarFilter, DoesNothingWithTooFewFeatures) {
  const geometry::Camera camera(geometry::MvsecDavis346());
  const JacobianTable jacobians(camera);
  std::vector<FeatureStep> steps;
  for (int i = 0; i < 15; ++i) steps.push_back({Vector2d(20.0 * i, 100.0), Vector2d(20.0 * i + 2.0, 101.0), 0.5});
  const auto positions = EpipolarFilter().Filter({Vector3d::UnitZ(), Vector3d::Zero()}, jacobians, kStepS, steps);
  for (std::size_t i = 0; i < steps.size(); ++i) EXPECT_EQ(positions[i], steps[i].measured);
}

}  // namespace
}  // namespace evo::tracking
