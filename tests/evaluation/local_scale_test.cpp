#include "evaluation/trajectory/local_scale.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace evo::evaluation {
namespace {

constexpr TimeNs kStep = 50'000'000;
constexpr TimeNs kGap = 500'000'000;

/// A curved drive of `n` poses 0.5 m apart; steps of the estimate are `scale(metres travelled)` times the true ones,
/// seen in a world turned and moved.
std::vector<PosePair> Drive(int n, const std::function<double(double)>& scale) {
  const geometry::SE3 world(geometry::so3::Exp({0.4, -1.0, 2.0}), Eigen::Vector3d(100, -50, 3));
  std::vector<PosePair> pairs;
  Eigen::Vector3d truth = Eigen::Vector3d::Zero();
  Eigen::Vector3d estimate = truth;
  for (int i = 0; i < n; ++i) {
    const Eigen::Quaterniond heading = geometry::so3::Exp({0, 0.01 * i, 0});
    pairs.push_back({i * kStep, i * kStep, world * geometry::SE3(heading, estimate), geometry::SE3(heading, truth)});
    const Eigen::Vector3d step = heading * Eigen::Vector3d(0, 0, 0.5);
    estimate += scale(0.5 * (i + 0.5)) * step;
    truth += step;
  }
  return pairs;
}

std::vector<ScaleSample> LocalScale(const std::vector<PosePair>& pairs, double scale = 1.0) {
  return ComputeLocalScale(BuildMatchedTrajectory(pairs, {scale, geometry::SE3()}), 0, kGap,
                           SegmentOptions().scale_segment_m);
}

TEST(LocalScale, IsOneForTheTruth) {
  const auto samples = LocalScale(Drive(400, [](double) { return 1.0; }));
  ASSERT_EQ(samples.size(), 400U);
  for (const auto& sample : samples) EXPECT_NEAR(sample.ratio, 1.0, 1e-9);
  EXPECT_NEAR(samples[100].distance, 50.0, 1e-9);
  EXPECT_NEAR(samples[100].seconds, 5.0, 1e-12);
}

TEST(LocalScale, IsRelativeToTheAlignment) {
  const auto pairs = Drive(400, [](double) { return 0.25; });
  for (const auto& sample : LocalScale(pairs, 4.0)) EXPECT_NEAR(sample.ratio, 1.0, 1e-9);
  for (const auto& sample : LocalScale(pairs, 2.0)) EXPECT_NEAR(sample.ratio, 2.0, 1e-9);
}

TEST(LocalScale, FollowsALinearDrift) {
  const auto drift = [](double metres) { return 1.0 + 0.002 * metres; };  // 40 % over 200 m
  for (const auto& sample : LocalScale(Drive(401, drift))) {
    // The window is two-sided up to half a segment from the ends.
    const bool inside = sample.distance >= 5.0 && sample.distance <= 195.0;
    EXPECT_NEAR(sample.ratio * drift(sample.distance), 1.0, inside ? 2e-4 : 6e-3) << sample.distance;
  }
}

TEST(LocalScale, StaysNearTheTruthUnderNoise) {
  auto pairs = Drive(400, [](double) { return 1.0; });
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 0.1);  // a fifth of a step: a ratio of path lengths would be 4 % off
  for (auto& pair : pairs) {
    const geometry::SE3& pose = pair.T_world_cam_estimate;
    const Eigen::Vector3d error(noise(random), noise(random), noise(random));
    pair.T_world_cam_estimate = geometry::SE3(pose.rotation(), pose.translation() + error);
  }
  double sum = 0.0;
  for (const auto& sample : LocalScale(pairs)) {
    EXPECT_NEAR(sample.ratio, 1.0, 0.05);
    sum += sample.ratio;
  }
  EXPECT_NEAR(sum / 400.0, 1.0, 0.005);
}

TEST(LocalScale, KeepsItsValueAtAStop) {
  auto pairs = Drive(200, [](double) { return 0.5; });
  const std::vector<PosePair> stop(5000, pairs[100]);
  pairs.insert(pairs.begin() + 100, stop.begin(), stop.end());
  for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i].t_truth = static_cast<TimeNs>(i) * kStep;
  const auto samples = LocalScale(pairs);
  ASSERT_EQ(samples.size(), 5200U);
  for (const auto& sample : samples) EXPECT_NEAR(sample.ratio, 2.0, 1e-9);
}

TEST(LocalScale, IsUndeterminedWithoutMotion) {
  const auto pairs = Drive(2, [](double) { return 1.0; });
  for (const auto& sample : LocalScale(std::vector(100, pairs[0]))) EXPECT_TRUE(std::isnan(sample.ratio));
  EXPECT_TRUE(LocalScale({}).empty());
  // The truth moves, the estimate does not.
  for (const auto& sample : LocalScale(Drive(100, [](double) { return 0.0; }))) {
    EXPECT_TRUE(std::isnan(sample.ratio));
  }
}

TEST(LocalScale, WindowEndsAtGaps) {
  const auto jump = [](double metres) { return metres < 100.0 ? 1.0 : 2.0; };
  auto pairs = Drive(400, jump);
  // A new map begins at 100 m, elsewhere and with another scale; then a piece of two poses, too short to judge.
  for (std::size_t i = 200; i < pairs.size(); ++i) {
    pairs[i].t_truth += 2 * kGap;
    auto& pose = pairs[i].T_world_cam_estimate;
    pose = geometry::SE3(pose.rotation(), pose.translation() + Eigen::Vector3d(1e4, 0, 0));
  }
  for (std::size_t i = 300; i < pairs.size(); ++i) pairs[i].t_truth += 2 * kGap;
  for (std::size_t i = 302; i < pairs.size(); ++i) pairs[i].t_truth += 2 * kGap;
  const auto samples = LocalScale(pairs);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i == 300 || i == 301) {
      EXPECT_TRUE(std::isnan(samples[i].ratio));
    } else {
      EXPECT_NEAR(samples[i].ratio, i < 200 ? 1.0 : 0.5, 1e-9) << i;
    }
  }
}

TEST(LocalScale, ShortPathsUseAFifthOfTheirLength) {
  // 2 m, far less than a segment; the scale halves in the middle and both ends must show it.
  auto pairs = Drive(401, [](double metres) { return metres < 100.0 ? 1.0 : 0.5; });
  for (auto& pair : pairs) {
    for (auto* pose : {&pair.T_world_cam_estimate, &pair.T_world_cam_truth}) {
      *pose = geometry::SE3(pose->rotation(), 0.01 * pose->translation());
    }
  }
  const auto samples = LocalScale(pairs);
  EXPECT_NEAR(samples.front().ratio, 1.0, 1e-9);
  EXPECT_NEAR(samples.back().ratio, 2.0, 1e-9);
}

}  // namespace
}  // namespace evo::evaluation
