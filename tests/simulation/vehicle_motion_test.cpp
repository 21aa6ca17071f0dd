#include "simulation/motion/vehicle_motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "evo/core/error.hpp"
#include "simulation/velocity_step.hpp"

namespace evo::simulation {
namespace {

constexpr double kPi = std::numbers::pi;

/// Without vibration and bumps.
VehicleOptions Quiet() {
  VehicleOptions options;
  options.vibration_deg = 0.0;
  return options;
}

double SpeedAt(const VehicleMotion& motion, double t) {
  return (motion.distance_m(FromSeconds(t + 0.001)) - motion.distance_m(FromSeconds(t - 0.001))) / 0.002;
}

TEST(VehicleMotion, CruisesAtConstantSpeed) {
  VehicleOptions options = Quiet();
  options.start_at_rest_s = 0.0;
  const VehicleMotion motion = MakeVehicleMotion(ReferenceLine("straight", 600.0, 0.0, 1), options, 1);
  EXPECT_EQ(motion.distance_m(0), 0.0);
  EXPECT_NEAR(motion.distance_m(FromSeconds(60.0)), 450.0, 1e-6);
  const geometry::SE3 pose = motion.T_world_cam(FromSeconds(20.0));
  EXPECT_LT((pose.translation() - Eigen::Vector3d(0.0, 0.0, 150.0)).norm(), 1e-6);
  EXPECT_LT(geometry::so3::Log(pose.rotation()).norm(), 1e-12);
  EXPECT_NEAR(SpeedAt(motion, 59.99), 7.5, 1e-6) << "no braking at the end of the run";
}

TEST(VehicleMotion, StartsAtRestThenAcceleratesAtItsLimit) {
  const VehicleMotion motion = MakeVehicleMotion(ReferenceLine("straight", 600.0, 0.0, 1), Quiet(), 1);
  EXPECT_EQ(motion.distance_m(FromSeconds(1.0)), 0.0);
  EXPECT_GT(motion.distance_m(FromSeconds(1.1)), 0.0);
  // 1.4 s is the middle of the smoothed start; 5 s of 1.5 m/s^2 from there to 7.5 m/s.
  EXPECT_NEAR(SpeedAt(motion, 3.4), 3.0, 0.01);
  EXPECT_NEAR(SpeedAt(motion, 7.0), 7.5, 1e-9);
  EXPECT_NEAR(motion.distance_m(FromSeconds(60.0)), 0.5 * 5.0 * 7.5 + (60.0 - 6.4) * 7.5, 0.05);
}

TEST(VehicleMotion, BrakesToAStopStandsAndGoesOn) {
  VehicleOptions options = Quiet();
  options.stop_every_s = 15.0;
  const VehicleMotion motion = MakeVehicleMotion(ReferenceLine("straight", 600.0, 0.0, 1), options, 1);
  EXPECT_NEAR(SpeedAt(motion, 14.5), 7.5, 1e-9);
  // Braking takes 5 s, then 0.4 s of smoothing, then 2 s at rest.
  EXPECT_EQ(motion.distance_m(FromSeconds(20.42)), motion.distance_m(FromSeconds(22.38)));
  EXPECT_GT(SpeedAt(motion, 20.2), 0.0);
  EXPECT_GT(SpeedAt(motion, 22.6), 0.0);
  EXPECT_NEAR(SpeedAt(motion, 29.0), 7.5, 1e-9);
}

TEST(VehicleMotion, AccelerationStaysWithinItsLimitAndChangesSmoothly) {
  VehicleOptions options = Quiet();
  options.stop_every_s = 12.0;
  const VehicleMotion motion = MakeVehicleMotion(ReferenceLine("turns", 440.0, 0.0, 2), options, 1);
  double last = 0.0, last_acceleration = 0.0;
  for (int i = 0; i <= 6000; ++i) {
    const double distance = motion.distance_m(FromSeconds(0.01 * i));
    ASSERT_GE(distance, last) << "never backwards";
    last = distance;
    if (i == 0) continue;
    const double acceleration = (SpeedAt(motion, 0.01 * i + 0.005) - SpeedAt(motion, 0.01 * i - 0.005)) / 0.01;
    ASSERT_LE(std::abs(acceleration), 1.5 * 1.02) << 0.01 * i;
    ASSERT_LE(std::abs(acceleration - last_acceleration), 0.2) << 0.01 * i;
    last_acceleration = acceleration;
  }
}

TEST(VehicleMotion, SlowsDownForTurnsAndEndsAtARightAngle) {
  const ReferenceLine road("turns", 80.0, 0.0, 2);
  ASSERT_EQ(road.junctions().size(), 1U);
  const VehicleMotion motion = MakeVehicleMotion(road, Quiet(), 1);
  double slowest = 1e9;
  for (double t = 5.0; motion.distance_m(FromSeconds(t)) < road.junctions().front() + 3.0; t += 0.01) {
    const double to_turn = std::abs(motion.distance_m(FromSeconds(t)) - road.junctions().front());
    if (to_turn < 3.0) {
      ASSERT_LE(SpeedAt(motion, t), 4.1);
    }
    slowest = std::min(slowest, SpeedAt(motion, t));
  }
  EXPECT_NEAR(slowest, 4.0, 0.1);
  const geometry::SE3 last = motion.T_world_cam(FromSeconds(60.0));
  EXPECT_NEAR(std::abs(geometry::so3::Log(last.rotation()).y()), 0.5 * kPi, 1e-6);
  EXPECT_NEAR(motion.distance_m(FromSeconds(60.0)), 80.0, 0.01) << "stops at the end of the road";
}

TEST(VehicleMotion, StartsAtTheIdentityAndKeepsItsHeightAboveTheRoad) {
  VehicleOptions options;
  options.bumps_at_s = "0,12";
  const ReferenceLine road("curved", 440.0, 0.08, 4);
  const VehicleMotion bumpy = MakeVehicleMotion(road, options, 1);
  EXPECT_EQ(bumpy.T_world_cam(0).translation(), Eigen::Vector3d::Zero());
  EXPECT_EQ(geometry::so3::Log(bumpy.T_world_cam(0).rotation()), Eigen::Vector3d::Zero());
  const VehicleMotion motion = MakeVehicleMotion(road, Quiet(), 1);
  for (double t = 0.0; t < 60.0; t += 0.7) {
    const auto point = road.PointAt(motion.distance_m(FromSeconds(t)));
    const Eigen::Vector3d below =
        motion.T_world_cam(FromSeconds(t)).Inverse() * Eigen::Vector3d(point.position + Eigen::Vector3d(0.0, 1.5, 0.0));
    ASSERT_LT((below - Eigen::Vector3d(0.0, 1.5, 0.0)).norm(), 1e-9) << "the road right below the camera";
    const Eigen::Vector3d ahead = motion.T_world_cam(FromSeconds(t)).rotation() * Eigen::Vector3d::UnitZ();
    ASSERT_NEAR(std::atan2(ahead.x(), ahead.z()), point.heading, 1e-9);
    ASSERT_NEAR(-ahead.y(), std::sin(point.pitch), 1e-9) << "looks up the hill";
  }
}

TEST(VehicleMotion, CameraPitchLooksDown) {
  VehicleOptions options = Quiet();
  options.camera_pitch_deg = 10.0;
  const VehicleMotion motion = MakeVehicleMotion(ReferenceLine("straight", 600.0, 0.0, 1), options, 1);
  const Eigen::Vector3d axis = motion.T_world_cam(FromSeconds(10.0)).rotation() * Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(axis.y(), std::sin(10.0 * kPi / 180.0), 1e-12);
  EXPECT_NEAR(motion.T_world_cam(FromSeconds(10.0)).translation().y(), 0.0, 1e-12) << "drives level all the same";
}

TEST(VehicleMotion, BumpHasItsPeaksAndDecays) {
  VehicleOptions options = Quiet();
  options.bumps_at_s = "30";
  const VehicleMotion motion = MakeVehicleMotion(ReferenceLine("straight", 600.0, 0.0, 1), options, 1);
  EXPECT_EQ(motion.T_world_cam(FromSeconds(29.9999)).translation().y(), 0.0);
  double pitch = 0.0, heave = 0.0, roll = 0.0, dive = 0.0;
  for (double t = 30.0; t < 33.0; t += 0.001) {
    const geometry::SE3 pose = motion.T_world_cam(FromSeconds(t));
    const Eigen::Vector3d turn = geometry::so3::Log(pose.rotation()) * 180.0 / kPi;
    pitch = std::max(pitch, turn.x());
    dive = std::min(dive, turn.x());
    roll = std::max(roll, std::abs(turn.z()));
    heave = std::max(heave, -pose.translation().y());
  }
  EXPECT_NEAR(pitch, 2.0, 0.01) << "nose up first";
  EXPECT_NEAR(heave, 0.06, 0.0005);
  EXPECT_NEAR(roll, 0.7, 0.01);
  // The next half swing of an oscillation damped by 0.35 is exp(-pi 0.35 / sqrt(1 - 0.35^2)) of the first.
  EXPECT_NEAR(dive / pitch, -std::exp(-kPi * 0.35 / std::sqrt(1.0 - 0.35 * 0.35)), 0.02);
  EXPECT_LT(std::abs(motion.T_world_cam(FromSeconds(32.99)).translation().y()), 1e-6);
}

TEST(VehicleMotion, BumpsActOnlyOnAMovingCar) {
  VehicleOptions options = Quiet();
  options.bumps_at_s = "2";
  options.start_at_rest_s = 5.0;
  const VehicleMotion motion = MakeVehicleMotion(ReferenceLine("straight", 600.0, 0.0, 1), options, 1);
  EXPECT_EQ(motion.T_world_cam(FromSeconds(2.2)).translation().y(), 0.0);
}

TEST(VehicleMotion, VelocityIsContinuousThroughBumpsTurnsAndVibration) {
  VehicleOptions options;
  options.bumps_at_s = "12,25,41.5";
  options.stop_every_s = 20.0;
  const ReferenceLine road("turns", 440.0, 0.05, 7);
  const VelocityStep step = LargestVelocityStep(MakeVehicleMotion(road, options, 7).T_world_cam, 0.0, 60.0);
  // Within 2 ms: a bump of 0.06 m needs up to 24 m/s^2, one of 2 degrees 14 rad/s^2, vibration of 0.05
  // degrees at 12 Hz up to 20 rad/s^2.
  EXPECT_LT(step.linear, 0.002 * 28.0);
  EXPECT_LT(step.angular, 0.002 * 40.0);
  const VelocityStep quiet = LargestVelocityStep(MakeVehicleMotion(road, Quiet(), 7).T_world_cam, 0.0, 60.0);
  EXPECT_LT(quiet.linear, 0.002 * 3.0) << "1.5 m/s^2 along and 2 m/s^2 across";
  EXPECT_LT(quiet.angular, 0.002 * 0.8) << "into a clothoid at 5 m/s";
}

TEST(VehicleMotion, VibrationHasItsDeviationAndIsSmallAtRest) {
  VehicleOptions options;
  options.start_at_rest_s = 20.0;
  const VehicleMotion motion = MakeVehicleMotion(ReferenceLine("straight", 600.0, 0.0, 1), options, 3);
  const auto deviation = [&](double from, double to) {
    double sum = 0.0;
    for (int i = 0; i < 10000; ++i) {
      sum +=
          geometry::so3::Log(motion.T_world_cam(FromSeconds(from + (to - from) * i / 10000)).rotation()).squaredNorm() /
          3e4;
    }
    return std::sqrt(sum) * 180.0 / kPi;
  };
  EXPECT_NEAR(deviation(30.0, 60.0), 0.05, 0.003);
  EXPECT_NEAR(deviation(1.0, 20.0), 0.005, 0.0003);
}

TEST(VehicleMotion, SameSeedSameMotion) {
  VehicleOptions options;
  options.bumps_at_s = "every 5";
  const ReferenceLine road("curved", 440.0, 0.05, 1);
  const auto a = MakeVehicleMotion(road, options, 1), b = MakeVehicleMotion(road, options, 1),
             c = MakeVehicleMotion(road, options, 2);
  const TimeNs t = FromSeconds(31.7);
  EXPECT_EQ(a.T_world_cam(t).Matrix(), b.T_world_cam(t).Matrix());
  EXPECT_NE(a.T_world_cam(t).Matrix(), c.T_world_cam(t).Matrix());
}

TEST(VehicleMotion, RejectsInvalidOptions) {
  const ReferenceLine road("straight", 100.0, 0.0, 1);
  VehicleOptions options;
  options.speed_m_s = 0.0;
  EXPECT_THROW(MakeVehicleMotion(road, options, 1), Error);
  options = {};
  options.duration_s = std::nan("");
  EXPECT_THROW(MakeVehicleMotion(road, options, 1), Error);
  options = {};
  options.bumps_at_s = "often";
  EXPECT_THROW(MakeVehicleMotion(road, options, 1), Error);
}

}  // namespace
}  // namespace evo::simulation
