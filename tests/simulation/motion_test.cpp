#include "evo/simulation/motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "evo/core/error.hpp"

namespace evo::simulation {
namespace {

constexpr double kPi = std::numbers::pi;

/// Without what shakes the camera.
VehicleOptions Quiet() {
  VehicleOptions options;
  options.vibration_deg = 0.0;
  return options;
}

double SpeedAt(const VehicleMotion& motion, double t) {
  return (motion.distance_m(FromSeconds(t + 0.001)) - motion.distance_m(FromSeconds(t - 0.001))) / 0.002;
}

/// Largest change of the velocity (m/s) and of the body's rate of rotation (rad/s) from one 2 ms to the next.
struct Jolt {
  double linear = 0.0;
  double angular = 0.0;
};
Jolt LargestJolt(const CameraMotion& motion, double from, double to) {
  constexpr double kStep = 0.002;
  Jolt jolt;
  Eigen::Vector3d last_velocity = Eigen::Vector3d::Zero(), last_rate = Eigen::Vector3d::Zero();
  bool first = true;
  for (double t = from; t < to; t += kStep) {
    const geometry::SE3 a = motion(FromSeconds(t)), b = motion(FromSeconds(t + kStep));
    const Eigen::Vector3d velocity = (b.translation() - a.translation()) / kStep;
    const Eigen::Vector3d rate = geometry::so3::Log(a.rotation().conjugate() * b.rotation()) / kStep;
    if (!first) {
      jolt.linear = std::max(jolt.linear, (velocity - last_velocity).norm());
      jolt.angular = std::max(jolt.angular, (rate - last_rate).norm());
    }
    last_velocity = velocity;
    last_rate = rate;
    first = false;
  }
  return jolt;
}

TEST(VehicleMotion, CruisesAtConstantSpeed) {
  VehicleOptions options = Quiet();
  options.start_at_rest_s = 0.0;
  const VehicleMotion motion = MakeVehicleMotion(RoadLine("straight", 600.0, 0.0, 1), options, 1);
  EXPECT_EQ(motion.distance_m(0), 0.0);
  EXPECT_NEAR(motion.distance_m(FromSeconds(60.0)), 450.0, 1e-6);
  const geometry::SE3 pose = motion.T_world_cam(FromSeconds(20.0));
  EXPECT_LT((pose.translation() - Eigen::Vector3d(0.0, 0.0, 150.0)).norm(), 1e-6);
  EXPECT_LT(geometry::so3::Log(pose.rotation()).norm(), 1e-12);
  EXPECT_NEAR(SpeedAt(motion, 59.99), 7.5, 1e-6) << "no braking at the end of the run";
}

TEST(VehicleMotion, StandsFirstThenSpeedsUpAtTheGivenRate) {
  const VehicleMotion motion = MakeVehicleMotion(RoadLine("straight", 600.0, 0.0, 1), Quiet(), 1);
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
  const VehicleMotion motion = MakeVehicleMotion(RoadLine("straight", 600.0, 0.0, 1), options, 1);
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
  const VehicleMotion motion = MakeVehicleMotion(RoadLine("turns", 440.0, 0.0, 2), options, 1);
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
  const RoadLine road("turns", 80.0, 0.0, 2);
  ASSERT_EQ(road.crossings().size(), 1U);
  const VehicleMotion motion = MakeVehicleMotion(road, Quiet(), 1);
  double slowest = 1e9;
  for (double t = 5.0; motion.distance_m(FromSeconds(t)) < road.crossings().front() + 3.0; t += 0.01) {
    const double to_turn = std::abs(motion.distance_m(FromSeconds(t)) - road.crossings().front());
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
  const RoadLine road("curved", 440.0, 0.08, 4);
  const VehicleMotion shaken = MakeVehicleMotion(road, options, 1);
  EXPECT_EQ(shaken.T_world_cam(0).translation(), Eigen::Vector3d::Zero());
  EXPECT_EQ(geometry::so3::Log(shaken.T_world_cam(0).rotation()), Eigen::Vector3d::Zero());
  const VehicleMotion motion = MakeVehicleMotion(road, Quiet(), 1);
  for (double t = 0.0; t < 60.0; t += 0.7) {
    const auto point = road.At(motion.distance_m(FromSeconds(t)));
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
  const VehicleMotion motion = MakeVehicleMotion(RoadLine("straight", 600.0, 0.0, 1), options, 1);
  const Eigen::Vector3d axis = motion.T_world_cam(FromSeconds(10.0)).rotation() * Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(axis.y(), std::sin(10.0 * kPi / 180.0), 1e-12);
  EXPECT_NEAR(motion.T_world_cam(FromSeconds(10.0)).translation().y(), 0.0, 1e-12) << "drives level all the same";
}

TEST(VehicleMotion, BumpHasItsPeaksThenDiesAway) {
  VehicleOptions options = Quiet();
  options.bumps_at_s = "30";
  const VehicleMotion motion = MakeVehicleMotion(RoadLine("straight", 600.0, 0.0, 1), options, 1);
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

TEST(VehicleMotion, BumpsShakeOnlyACarThatMoves) {
  VehicleOptions options = Quiet();
  options.bumps_at_s = "2";
  options.start_at_rest_s = 5.0;
  const VehicleMotion motion = MakeVehicleMotion(RoadLine("straight", 600.0, 0.0, 1), options, 1);
  EXPECT_EQ(motion.T_world_cam(FromSeconds(2.2)).translation().y(), 0.0);
}

TEST(VehicleMotion, VelocityIsContinuousThroughBumpsTurnsAndVibration) {
  VehicleOptions options;
  options.bumps_at_s = "12,25,41.5";
  options.stop_every_s = 20.0;
  const RoadLine road("turns", 440.0, 0.05, 7);
  const Jolt jolt = LargestJolt(MakeVehicleMotion(road, options, 7).T_world_cam, 0.0, 60.0);
  // Within 2 ms: a bump of 0.06 m needs up to 24 m/s^2, one of 2 degrees 14 rad/s^2, vibration of 0.05
  // degrees at 12 Hz up to 20 rad/s^2.
  EXPECT_LT(jolt.linear, 0.002 * 28.0);
  EXPECT_LT(jolt.angular, 0.002 * 40.0);
  const Jolt quiet = LargestJolt(MakeVehicleMotion(road, Quiet(), 7).T_world_cam, 0.0, 60.0);
  EXPECT_LT(quiet.linear, 0.002 * 3.0) << "1.5 m/s^2 along and 2 m/s^2 across";
  EXPECT_LT(quiet.angular, 0.002 * 0.8) << "into a clothoid at 5 m/s";
}

TEST(VehicleMotion, VibrationHasItsSizeAndIsSmallAtRest) {
  VehicleOptions options;
  options.start_at_rest_s = 20.0;
  const VehicleMotion motion = MakeVehicleMotion(RoadLine("straight", 600.0, 0.0, 1), options, 3);
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
  const RoadLine road("curved", 440.0, 0.05, 1);
  const auto a = MakeVehicleMotion(road, options, 1), b = MakeVehicleMotion(road, options, 1),
             c = MakeVehicleMotion(road, options, 2);
  const TimeNs t = FromSeconds(31.7);
  EXPECT_EQ(a.T_world_cam(t).Matrix(), b.T_world_cam(t).Matrix());
  EXPECT_NE(a.T_world_cam(t).Matrix(), c.T_world_cam(t).Matrix());
}

TEST(VehicleMotion, ReadsTimesOfBumps) {
  VehicleOptions options;
  EXPECT_TRUE(BumpTimes(options).empty());
  options.bumps_at_s = "52, 48.5,70";
  EXPECT_EQ(BumpTimes(options), (std::vector<double>{48.5, 52.0})) << "in order, within the run";
  options.bumps_at_s = "every 15";
  EXPECT_EQ(BumpTimes(options), (std::vector<double>{15.0, 30.0, 45.0, 60.0}));
  Parameters parameters;
  Register(parameters, options);
  parameters.Set("motion.vehicle.bumps_at_s=52,60");
  EXPECT_EQ(options.bumps_at_s, "52,60");
  for (const std::string text : {"often", "every", "every 0", "every -1", "5,", ",5", "5;6", "-3", "nan", "1e400"}) {
    options.bumps_at_s = text;
    EXPECT_THROW(BumpTimes(options), Error) << text;
    EXPECT_THROW(parameters.Set("motion.vehicle.bumps_at_s=" + text), Error) << text;
  }
}

TEST(VehicleMotion, RefusesImpossibleOptions) {
  const RoadLine road("straight", 100.0, 0.0, 1);
  VehicleOptions options;
  options.speed_m_s = 0.0;
  EXPECT_THROW(MakeVehicleMotion(road, options, 1), Error);
  options = {};
  options.duration_s = std::nan("");
  EXPECT_THROW(MakeVehicleMotion(road, options, 1), Error);
}

TEST(HandheldMotion, StartsAtRestAndHasItsSize) {
  HandheldOptions options;
  options.duration_s = 400.0;
  const CameraMotion motion = MakeHandheldMotion(options, 5);
  EXPECT_EQ(motion(0).Matrix(), geometry::SE3().Matrix());
  EXPECT_LT(motion(FromSeconds(0.01)).translation().norm(), 1e-5);
  double translation = 0.0, rotation = 0.0, farthest = 0.0;
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) {
    const geometry::SE3 pose = motion(FromSeconds(2.0 + 0.02 * i));
    translation += pose.translation().squaredNorm() / (3.0 * kSamples);
    rotation += geometry::so3::Log(pose.rotation()).squaredNorm() / (3.0 * kSamples);
    farthest = std::max(farthest, pose.translation().cwiseAbs().maxCoeff());
  }
  EXPECT_NEAR(std::sqrt(translation), 0.3, 0.01);
  EXPECT_NEAR(std::sqrt(rotation) * 180.0 / kPi, 12.0, 0.4);
  EXPECT_LT(farthest, 1.2);
  const Jolt jolt = LargestJolt(motion, 0.0, 30.0);
  EXPECT_LT(jolt.linear, 0.002 * 8.0);
  EXPECT_LT(jolt.angular, 0.002 * 8.0);
  EXPECT_EQ(motion(FromSeconds(9.0)).Matrix(), MakeHandheldMotion(options, 5)(FromSeconds(9.0)).Matrix());
  EXPECT_NE(motion(FromSeconds(9.0)).Matrix(), MakeHandheldMotion(options, 6)(FromSeconds(9.0)).Matrix());
}

TEST(SliderMotion, CoversItsLengthAtConstantSpeed) {
  const CameraMotion motion = MakeSliderMotion({});
  EXPECT_EQ(motion(0).Matrix(), geometry::SE3().Matrix());
  EXPECT_NEAR(motion(FromSeconds(3.0)).translation().x(), 0.6, 1e-12);
  const double speed = 0.6 / 2.95;
  EXPECT_NEAR(motion(FromSeconds(2.0)).translation().x() - motion(FromSeconds(1.0)).translation().x(), speed, 1e-12);
  EXPECT_LT(LargestJolt(motion, 0.0, 3.0).linear, 0.002 * 1.5 * speed / 0.1 * 1.01);
  EXPECT_THROW(MakeSliderMotion({0.05, 1.0}), Error);
}

TEST(TrueTrajectory, SamplesTheMotionUpToItsEnd) {
  const CameraMotion motion = MakeSliderMotion({});
  const TimeNs epoch = 1'504'645'177'420'000'123;
  const geometry::Trajectory truth = TrueTrajectory(motion, FromSeconds(3.0), 20.0, epoch);
  ASSERT_EQ(truth.size(), 61U);
  EXPECT_EQ(truth.front().t, epoch);
  EXPECT_EQ(truth.back().t, epoch + FromSeconds(3.0));
  EXPECT_EQ(truth[7].T_world_cam.Matrix(), motion(FromSeconds(0.35)).Matrix());
  EXPECT_THROW(TrueTrajectory(motion, 1, 0.0, 0), Error);
}

}  // namespace
}  // namespace evo::simulation
