#include "simulation/motion/spline_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "evo/core/error.hpp"
#include "evo/core/random.hpp"
#include "evo/simulation/simulated_run.hpp"
#include "simulation/motion/handheld_motion.hpp"

namespace evo::simulation {
namespace {

constexpr TimeNs kEpoch = 1'504'645'177'000'000'000;

geometry::Trajectory SampleFromEpoch(const PoseFunction& motion, double duration_s, double hz) {
  geometry::Trajectory trajectory = SamplePoses(motion, FromSeconds(duration_s), hz);
  for (auto& pose : trajectory) pose.t += kEpoch;
  return trajectory;
}

double Difference(const geometry::SE3& a, const geometry::SE3& b) { return (a.Inverse() * b).Log().norm(); }

TEST(SplineMotion, PassesThroughThePosesAtUnevenTimes) {
  const PoseFunction motion = MakeHandheldMotion({}, 11);
  geometry::Trajectory trajectory;
  Random random(3);
  for (TimeNs t = 0; t < FromSeconds(20.0); t += FromSeconds(random.Uniform(0.02, 0.2))) {
    trajectory.push_back({kEpoch + t, motion(t)});
  }
  const PoseFunction through = MakeSplineMotion(trajectory);
  EXPECT_LT(Difference(through(0), geometry::SE3()), 1e-12);
  for (const auto& pose : trajectory) ASSERT_LT(Difference(through(pose.t - kEpoch), pose.T_world_cam), 1e-9);
}

TEST(SplineMotion, ReconstructsASmoothMotionFromItsSamples) {
  const PoseFunction motion = MakeHandheldMotion({}, 12);
  const auto worst = [&](double rate) {
    const PoseFunction through = MakeSplineMotion(SampleFromEpoch(motion, 20.0, rate));
    double largest = 0.0;
    for (double t = 1.0; t < 19.0; t += 0.0137) {
      largest = std::max(largest, Difference(through(FromSeconds(t)), motion(FromSeconds(t))));
    }
    return largest;
  };
  EXPECT_LT(worst(20.0), 2e-4);
  EXPECT_LT(worst(40.0), worst(20.0) / 6.0) << "third order or better";
}

TEST(SplineMotion, VelocityIsContinuousAtThePoses) {
  const PoseFunction motion = MakeHandheldMotion({20.0, 0.3, 30.0, 1.0}, 13);
  const PoseFunction through = MakeSplineMotion(SampleFromEpoch(motion, 20.0, 5.0));
  constexpr TimeNs kStep = 10'000;
  for (int i = 1; i < 100; ++i) {
    const TimeNs t = i * FromSeconds(0.2);
    const geometry::Vector6d before = (through(t - kStep).Inverse() * through(t)).Log() / ToSeconds(kStep);
    const geometry::Vector6d after = (through(t).Inverse() * through(t + kStep)).Log() / ToSeconds(kStep);
    ASSERT_LT((after - before).norm(), 2e-3) << t;
    ASSERT_GT(after.norm(), 1e-3);
  }
}

TEST(SplineMotion, MovesTheWorldToTheFirstPose) {
  const PoseFunction motion = MakeHandheldMotion({}, 14);
  const geometry::SE3 T_other_world =
      geometry::SE3::Exp((geometry::Vector6d() << 5.0, -3.0, 2.0, 0.4, 1.0, -0.7).finished());
  geometry::Trajectory trajectory = SamplePoses(motion, FromSeconds(5.0), 20.0);
  const PoseFunction here = MakeSplineMotion(trajectory);
  for (auto& pose : trajectory) pose.T_world_cam = T_other_world * pose.T_world_cam;
  const PoseFunction there = MakeSplineMotion(trajectory);
  EXPECT_LT(Difference(here(FromSeconds(3.21)), there(FromSeconds(3.21))), 1e-9);
}

TEST(SplineMotion, TwoPosesGiveAConstantVelocity) {
  const geometry::SE3 end(geometry::so3::Exp({0.0, 0.6, 0.0}), {1.0, 2.0, 3.0});
  const PoseFunction motion = MakeSplineMotion({{0, geometry::SE3()}, {kNsPerSecond, end}});
  const geometry::SE3 middle = motion(kNsPerSecond / 4);
  EXPECT_LT((middle.translation() - Eigen::Vector3d(0.25, 0.5, 0.75)).norm(), 1e-12);
  EXPECT_LT((geometry::so3::Log(middle.rotation()) - Eigen::Vector3d(0.0, 0.15, 0.0)).norm(), 1e-12);
}

TEST(SplineMotion, RejectsTooFewPosesAndTimesOutside) {
  EXPECT_THROW(MakeSplineMotion({}), Error);
  EXPECT_THROW(MakeSplineMotion({{0, geometry::SE3()}}), Error);
  EXPECT_THROW(MakeSplineMotion({{5, geometry::SE3()}, {5, geometry::SE3()}}), Error);
  EXPECT_THROW(MakeSplineMotion({{0, geometry::SE3()}, {5, geometry::SE3({1, 0, 0, 0}, {std::nan(""), 0, 0})}}), Error);
  const PoseFunction motion = MakeSplineMotion({{100, geometry::SE3()}, {200, geometry::SE3()}});
  EXPECT_NO_THROW(motion(100));
  EXPECT_THROW(motion(101), Error);
  EXPECT_THROW(motion(-1), Error);
}

}  // namespace
}  // namespace evo::simulation
