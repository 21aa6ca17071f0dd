#include "odometry/frontend/bootstrap.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "odometry/drive_messages.hpp"

namespace evo::odometry {
namespace {

constexpr double kFocal = 226.0;
constexpr double kNoisePx = 0.2;
constexpr double kDegree = std::numbers::pi / 180.0;

struct Scene {
  int points = 100;
  double outlier_ratio = 0.0;                          // of tracks on moving objects
  Eigen::Vector3d step = Eigen::Vector3d::Zero();      // of the camera between frames
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();  // the same, rad
};

struct Recording {
  std::vector<Frame> frames;   // with their true poses
  std::vector<bool> outliers;  // of the tracks
};

/// Points at depths of 4 to 20, observed by a camera without distortion while they are in the image.
Recording Record(const Scene& scene, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> x(-170.0, 170.0), y(-125.0, 125.0), depth(4.0, 20.0), drift(-2.0, 2.0);
  std::normal_distribution<double> noise(0.0, kNoisePx);
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector2d> drifts;  // px a frame
  Recording recording;
  for (int p = 0; p < scene.points; ++p) {
    points.emplace_back(depth(random) * Eigen::Vector3d(x(random) / kFocal, y(random) / kFocal, 1.0));
    recording.outliers.push_back(p < scene.outlier_ratio * scene.points);
    drifts.emplace_back(Eigen::Vector2d::Zero());
    if (recording.outliers.back()) drifts.back() = {drift(random), drift(random)};
  }
  for (int i = 0; i < 40; ++i) {
    Frame frame{
        FromSeconds(0.02) * i, geometry::SE3(geometry::so3::Exp(i * scene.rotation), i * scene.step).Inverse(), {}};
    for (int p = 0; p < scene.points; ++p) {
      const Eigen::Vector3d q = frame.T_cam_world * points[p];
      const Eigen::Vector2d px =
          kFocal * q.head<2>() / q.z() + i * drifts[p] + Eigen::Vector2d(noise(random), noise(random));
      if (q.z() < 1.0 || std::abs(px.x()) > 172.0 || std::abs(px.y()) > 129.0) continue;
      frame.features.push_back({p, px / kFocal, kFocal * Eigen::Matrix2d::Identity()});
    }
    recording.frames.push_back(frame);
  }
  return recording;
}

/// The first map, or the failure reason.
std::optional<Bootstrap> FirstMap(const Recording& recording, std::string* failure_reason = nullptr,
                                  const BootstrapOptions& options = {}) {
  Bootstrapper bootstrapper(options, recording.frames, kFocal);
  for (int i = 0; i < static_cast<int>(recording.frames.size()); ++i) {
    if (auto bootstrap = bootstrapper.Add(i)) return bootstrap;
  }
  if (failure_reason) *failure_reason = bootstrapper.failure_reason();
  return std::nullopt;
}

enum class Motion { kForward, kSideways, kOblique };

Scene RandomScene(Motion motion, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0), both(-1.0, 1.0);
  const double angle = std::numbers::pi * both(random);
  const Eigen::Vector3d sideways(std::cos(angle), std::sin(angle), 0.0);
  const double forward = both(random);
  Scene scene{.points = 60 + static_cast<int>(91 * unit(random)), .outlier_ratio = 0.2 + 0.1 * unit(random)};
  scene.rotation = 0.002 * Eigen::Vector3d(both(random), both(random), both(random));
  scene.step = 0.05 * sideways;
  if (motion == Motion::kForward) scene.step = Eigen::Vector3d(0.0, 0.0, 0.15);
  if (motion == Motion::kOblique) scene.step.z() = 0.1 * forward;
  return scene;
}

TEST(Bootstrapper, EstimatesTheMotionAndRejectsOutliers) {
  for (const Motion motion : {Motion::kForward, Motion::kSideways, Motion::kOblique}) {
    double outliers = 0.0, kept_outliers = 0.0;
    for (std::uint32_t seed = 1; seed <= 8; ++seed) {
      const Recording recording = Record(RandomScene(motion, seed), seed);
      const auto bootstrap = FirstMap(recording);
      ASSERT_TRUE(bootstrap) << seed;
      const Frame& first = recording.frames[bootstrap->first];
      const Frame& last = recording.frames[bootstrap->last];
      const geometry::SE3 truth = last.T_cam_world * first.T_cam_world.Inverse();
      const geometry::SE3& found = bootstrap->T_cam_world.back();
      const double cosine = found.translation().normalized().dot(truth.translation().normalized());
      // Medians are 0.05 and 0.5 degrees.
      EXPECT_LT(geometry::so3::Log(found.rotation() * truth.rotation().conjugate()).norm(), 0.3 * kDegree) << seed;
      EXPECT_GT(cosine, std::cos(4.0 * kDegree)) << seed;
      const auto is_outlier = [&](std::int64_t track) { return recording.outliers[track]; };
      const auto pairs = Match(first, last);
      const auto all_bad = std::ranges::count_if(pairs, [&](auto& pair) { return is_outlier(pair.first->track); });
      const auto bad = std::ranges::count_if(bootstrap->points, is_outlier, &Point::track);
      const auto good = static_cast<double>(bootstrap->points.size()) - bad;
      EXPECT_GE(good, 0.95 * (static_cast<double>(pairs.size()) - all_bad)) << seed;
      outliers += all_bad;
      kept_outliers += bad;
    }
    // Some outliers move along their epipolar lines.
    EXPECT_LT(kept_outliers, 0.3 * outliers) << static_cast<int>(motion);
  }
}

TEST(Bootstrapper, StartsWhereMostTracksAreObserved) {
  Recording recording = Record({.step = {0.05, 0.0, 0.0}}, 1);
  for (int i = 0; i < 5; ++i) {
    std::erase_if(recording.frames[i].features, [](const Feature& feature) { return feature.track >= 25; });
  }
  const auto begin = [&](double ratio) {
    const auto bootstrap = FirstMap(recording, nullptr, {.min_shared_ratio = ratio});
    return bootstrap ? bootstrap->first : -1;
  };
  EXPECT_EQ(begin(0.0), 0);
  EXPECT_GE(begin(0.5), 5);
}

/// All tracks end after seven frames, in which the image moves about 7 px.
TEST(Bootstrapper, StartsFromManyShortTracksBelowTheDisparity) {
  const auto first_map = [](int points, double step) {
    Recording recording = Record({.points = points, .step = {step, 0.0, 0.0}}, 1);
    for (std::size_t i = 0; i < recording.frames.size(); ++i) {
      const auto life = static_cast<std::int64_t>(i / 7);
      for (Feature& feature : recording.frames[i].features) feature.track += 1000 * life;
    }
    return FirstMap(recording);
  };
  const auto bootstrap = first_map(100, 0.05);
  ASSERT_TRUE(bootstrap);
  EXPECT_GT(bootstrap->T_cam_world.back().Inverse().translation().normalized().x(), std::cos(4.0 * kDegree));
  EXPECT_FALSE(first_map(40, 0.05));   // little motion of few tracks proves nothing
  EXPECT_FALSE(first_map(100, 0.01));  // hardly any motion
}

TEST(Bootstrapper, RejectsAStandingCamera) {
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    std::string failure_reason;
    EXPECT_FALSE(FirstMap(Record({.outlier_ratio = 0.3}, seed), &failure_reason)) << seed;
    EXPECT_NE(failure_reason.find("too little motion"), std::string::npos) << failure_reason;
  }
}

TEST(Bootstrapper, RejectsAPureRotation) {
  for (std::uint32_t seed = 1; seed <= 15; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> both(-0.01, 0.01);
    const Scene scene{.rotation = {both(random), both(random), both(random)}};
    EXPECT_FALSE(FirstMap(Record(scene, seed))) << seed;
  }
}

TEST(Bootstrapper, RejectsTracksWithoutARigidMotion) {
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    std::string failure_reason;
    EXPECT_FALSE(FirstMap(Record({.points = 60, .outlier_ratio = 1.0}, seed), &failure_reason)) << seed;
    EXPECT_NE(failure_reason.find("no rigid motion"), std::string::npos) << failure_reason;
  }
}

TEST(Bootstrapper, FindsForwardMotion) {
  for (std::uint32_t seed = 1; seed <= 8; ++seed) {
    const auto drive = testing::MakeDrive({.seconds = 2.0, .stop = false, .bumps = false, .seed = seed});
    const auto frames = BuildFrames(drive.tracks, testing::DriveCamera());
    const Bootstrap bootstrap = testing::FirstMapOfDrive(frames);
    const geometry::SE3 truth =
        drive.truth[bootstrap.last].T_world_cam.Inverse() * drive.truth[bootstrap.first].T_world_cam;
    const geometry::SE3& found = bootstrap.T_cam_world.back();
    EXPECT_LT(geometry::so3::Log(found.rotation() * truth.rotation().conjugate()).norm(), 0.01) << seed;
    const double cosine = found.translation().normalized().dot(truth.translation().normalized());
    EXPECT_GT(cosine, std::cos(0.1)) << seed;
    EXPECT_GE(bootstrap.points.size(), 25u) << seed;
  }
}

TEST(Bootstrapper, BuildsAMapWithoutRefinement) {
  const auto drive = testing::MakeDrive({.seconds = 2.0, .stop = false, .bumps = false});
  const auto frames = BuildFrames(drive.tracks, testing::DriveCamera());
  const Bootstrap refined = testing::FirstMapOfDrive(frames);
  const Bootstrap plain = testing::FirstMapOfDrive(frames, {.refine = false});
  EXPECT_EQ(plain.T_cam_world.size(), static_cast<std::size_t>(plain.last - plain.first + 1));
  EXPECT_GE(plain.points.size(), 25u);
  EXPECT_GT(plain.T_cam_world.back().translation().norm(), 0.0);
  EXPECT_NE(plain.T_cam_world.back().translation(), refined.T_cam_world.back().translation());
}

}  // namespace
}  // namespace evo::odometry
