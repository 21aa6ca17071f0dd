#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "evo/core/error.hpp"
#include "evo/odometry/map_writer.hpp"
#include "odometry/frontend/bootstrap.hpp"
#include "odometry/frontend/frame_builder.hpp"
#include "odometry/mapping/mapping_thread.hpp"
#include "odometry/mapping/segment_alignment.hpp"
#include "odometry/synthetic_drive.hpp"

namespace evo::odometry {
namespace {

using testing::DriveCamera;
using testing::MakeDrive;

Bootstrap FirstMap(const std::vector<Frame>& frames, const BootstrapOptions& options = {}) {
  Bootstrapper bootstrapper(options, frames, DriveCamera().focal_px());
  for (int i = 0; i < static_cast<int>(frames.size()); ++i) {
    if (auto bootstrap = bootstrapper.Add(i)) return *bootstrap;
  }
  throw std::runtime_error(bootstrapper.failure_reason());
}

TEST(Bootstrapper, FindsForwardMotion) {
  for (std::uint32_t seed = 1; seed <= 8; ++seed) {
    const auto drive = MakeDrive({.seconds = 2.0, .stop = false, .bumps = false, .seed = seed});
    const auto frames = BuildFrames(drive.tracks, DriveCamera());
    const Bootstrap bootstrap = FirstMap(frames);
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
  const auto drive = MakeDrive({.seconds = 2.0, .stop = false, .bumps = false});
  const auto frames = BuildFrames(drive.tracks, DriveCamera());
  const Bootstrap refined = FirstMap(frames);
  const Bootstrap plain = FirstMap(frames, {.refine = false});
  EXPECT_EQ(plain.T_cam_world.size(), static_cast<std::size_t>(plain.last - plain.first + 1));
  EXPECT_GE(plain.points.size(), 25u);
  EXPECT_GT(plain.T_cam_world.back().translation().norm(), 0.0);
  EXPECT_NE(plain.T_cam_world.back().translation(), refined.T_cam_world.back().translation());
}

/// The messages of the pose thread for a drive with its true poses.
std::vector<FrameMessage> Messages(int count) {
  const auto drive = MakeDrive({.seconds = 3.0, .stop = false, .seed = 3});
  const auto frames = BuildFrames(drive.tracks, DriveCamera());
  const Bootstrap bootstrap = FirstMap(frames);
  std::vector<FrameMessage> messages;
  int key_frame = -1;
  geometry::SE3 T_key_world;
  for (int i = bootstrap.first; i < bootstrap.first + count; ++i) {
    const auto place = static_cast<std::size_t>(i - bootstrap.first);
    const double scale =
        bootstrap.T_cam_world.back().translation().norm() /
        (drive.truth[bootstrap.last].T_world_cam.translation() - drive.truth[bootstrap.first].T_world_cam.translation())
            .norm();
    const geometry::SE3 relative = drive.truth[i].T_world_cam.Inverse() * drive.truth[bootstrap.first].T_world_cam;
    const geometry::SE3 pose(relative.rotation(), scale * relative.translation());
    FrameMessage message;
    message.index = i;
    message.frame = frames[i];
    message.pose = {key_frame, pose * T_key_world.Inverse()};
    message.is_key_frame = place % 5 == 0;
    if (place == 0) message.new_map = bootstrap.points;
    if (message.is_key_frame) {
      ++key_frame;
      T_key_world = pose;
    }
    messages.push_back(std::move(message));
  }
  return messages;
}

TEST(Mapper, GrowsTheMapAndRemovesContradictedPoints) {
  Mapper mapper({}, 1.0 / 226.0);
  auto messages = Messages(60);
  const std::size_t initial = messages[0].new_map->size();
  const std::int64_t victim = messages[0].new_map->front().track;
  bool removed = false;
  for (auto& message : messages) {
    if (mapper.map().Find(victim)) message.outliers.push_back(victim);
    const MapUpdate update = mapper.Process(message);
    EXPECT_EQ(update.index, message.index);
    removed |= std::ranges::find(update.removed, victim) != update.removed.end();
  }
  EXPECT_TRUE(removed);
  EXPECT_GT(mapper.map().points.size(), initial + 50);
  EXPECT_EQ(mapper.map().key_frames.size(), 12u);
}

TEST(Mapper, OldKeyFramesMakeSeedsConvergeEarlier) {
  std::vector<std::size_t> points;
  for (const int old_key_frames : {0, 6}) {
    MapperOptions options;
    options.old_key_frames = old_key_frames;
    options.depth_filter.max_age = 1;  // most seeds are dropped and created again
    options.depth_filter.convergence = 500.0;
    Mapper mapper(options, 1.0 / 226.0);
    points.push_back(0);
    for (const auto& message : Messages(60)) {
      mapper.Process(message);
      points.back() += mapper.map().points.size();
    }
  }
  EXPECT_GT(points[1], points[0]);  // summed over the frames
}

TEST(MappingThread, UpdatesDoNotDependOnTheThread) {
  const auto messages = Messages(40);
  std::vector<std::vector<MapUpdate>> runs;
  for (const bool threaded : {false, true}) {
    Mapper mapper({}, 1.0 / 226.0);
    MappingThread thread(&mapper, threaded);
    auto& updates = runs.emplace_back();
    for (const auto& message : messages) {
      for (auto& update : thread.Collect(message.index - 2)) updates.push_back(std::move(update));
      EXPECT_EQ(updates.size(), static_cast<std::size_t>(std::max(0, message.index - messages[0].index - 1)));
      thread.Post(message);
    }
    for (auto& update : thread.Collect(messages.back().index)) updates.push_back(std::move(update));
  }
  ASSERT_EQ(runs[0].size(), messages.size());
  ASSERT_EQ(runs[1].size(), messages.size());
  for (std::size_t i = 0; i < messages.size(); ++i) {
    EXPECT_EQ(runs[0][i].index, runs[1][i].index);
    EXPECT_EQ(runs[0][i].points, runs[1][i].points);
    EXPECT_EQ(runs[0][i].removed, runs[1][i].removed);
  }
}

TEST(SegmentAlignment, RecoversASimilarityDespiteOutliers) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-10.0, 10.0);
  const geometry::SE3 T_world_local(geometry::so3::Exp({0.1, 0.7, -0.2}), Eigen::Vector3d(5, -1, 30));
  std::vector<Point> points;
  std::unordered_map<std::int64_t, Eigen::Vector3d> old_points;
  for (int i = 0; i < 30; ++i) {
    points.push_back({i, Eigen::Vector3d(uniform(random), uniform(random), uniform(random)), 0, 0});
    old_points[i] = T_world_local * (2.5 * points.back().position);
    if (i % 7 == 0) old_points[i].x() += 40.0;
  }
  const auto similarity = AlignByPoints(points, old_points);
  ASSERT_TRUE(similarity);
  EXPECT_NEAR(similarity->scale, 2.5, 1e-6);
  EXPECT_LT((similarity->T_world_local.Matrix() - T_world_local.Matrix()).norm(), 1e-5);
  points.resize(5);
  EXPECT_FALSE(AlignByPoints(points, old_points));
}

TEST(MapWriter, WritesPly) {
  const auto folder = std::filesystem::path(::testing::TempDir()) / "evo_map_writer_test";
  const auto path = folder / "map.ply";
  WriteMap({{7, {1.5, -2.0, 3.25}, 4, 0}}, path);
  std::ifstream file(path);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(text.substr(0, 4), "ply\n");
  EXPECT_NE(text.find("element vertex 1\n"), std::string::npos);
  EXPECT_NE(text.find("end_header\n1.5 -2 3.25 7 4\n"), std::string::npos) << text;
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace evo::odometry
