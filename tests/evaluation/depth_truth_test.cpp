#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>

#include "evaluation/track_scene.hpp"
#include "evo/core/error.hpp"
#include "evo/evaluation/track_accuracy.hpp"
#include "evo/evaluation/track_truth.hpp"

namespace evo::evaluation {
namespace {

using testing::TrackScene;

constexpr double kFloatPx = 2e-4;  // what depths stored as float32 cost

class DepthTruthTest : public ::testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path); }

  std::vector<TrueTrack> Find(const TrackScene& scene, const events::Tracks& tracks,
                              const TrackTruthOptions& options = {}) {
    scene.WriteGroundTruth(path);
    return TruthFromDepth(GroupById(tracks), scene.Poses(), scene.camera, io::DepthMapReader(path), kNsPerSecond,
                          options);
  }

  /// The largest distance from the truth; all positions must be known.
  static double LargestError(const events::Tracks& track, const TrueTrack& truth) {
    double largest = 0.0;
    for (std::size_t i = 0; i < track.size(); ++i) {
      EXPECT_TRUE(truth.positions[i]) << i;
      const Eigen::Vector2d seen(track[i].x, track[i].y);
      if (truth.positions[i]) largest = std::max(largest, (*truth.positions[i] - seen).norm());
    }
    return largest;
  }

  const std::filesystem::path path =
      std::filesystem::temp_directory_path() /
      ("evo_depth_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) +
       std::to_string(::getpid()) + ".hdf5");
};

TEST_F(DepthTruthTest, PerfectTracksOnATiltedPlaneEqualTheTruth) {
  TrackScene scene;
  scene.walls = {{Eigen::Vector3d(0.06, -0.03, 0.1)}};
  scene.velocity = {4.0, 0.5, 6.0};
  scene.turning = {0.2, -0.5, 1.0};
  scene.seconds = 0.7;
  for (const double from : {0.0, 0.111, 0.324, 0.338}) {  // on a map, after one, between two
    const events::Tracks track = scene.Follow(3, {80.3, 60.8}, from, from + 0.2);
    const auto truth = Find(scene, track);
    ASSERT_EQ(truth.size(), 1u);
    EXPECT_EQ(truth[0].status, TrackStatus::kEvaluated);
    EXPECT_TRUE(truth[0].starts_at_observation);
    EXPECT_LT(LargestError(track, truth[0]), kFloatPx) << from;
  }
}

TEST_F(DepthTruthTest, IncludesLensDistortion) {
  TrackScene scene;
  scene.camera = testing::MvsecCamera();
  scene.velocity = {0.3, 0.0, 3.0};
  scene.seconds = 0.6;
  for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(40.2, 30.7), {300.5, 220.1}, {170.0, 128.0}}) {
    const events::Tracks track = scene.Follow(1, pixel, 0.03, 0.2);
    EXPECT_LT(LargestError(track, Find(scene, track)[0]), 5e-3);  // inverse depth is not linear in distorted pixels
  }
}

TEST_F(DepthTruthTest, TrackDriftDoesNotChangeTheTruth) {
  const TrackScene scene;
  const events::Tracks perfect = scene.Follow(1, {150, 75}, 0.2, 1.0);
  events::Tracks drifting = perfect;
  for (std::size_t i = 0; i < drifting.size(); ++i) drifting[i].x += 0.1 * static_cast<double>(i);
  EXPECT_LT(LargestError(perfect, Find(scene, drifting)[0]), kFloatPx);
}

TEST_F(DepthTruthTest, VisibleUntilThePointLeavesTheImage) {
  const TrackScene scene;  // 10 px/s to the left
  const events::Tracks track = scene.Follow(1, {12.5, 75}, 0.02, 1.5);
  const auto truth = Find(scene, track)[0];
  ASSERT_TRUE(truth.visible_until);
  EXPECT_NEAR(ToSeconds(*truth.visible_until - testing::kSceneStart), 0.02 + 1.25, 1e-5);
  for (std::size_t i = 0; i < track.size(); ++i) EXPECT_EQ(truth.positions[i].has_value(), track[i].x >= 0.0) << i;
}

TEST_F(DepthTruthTest, VisibleUntilThePosesEnd) {
  const TrackScene scene;
  EXPECT_EQ(Find(scene, scene.Follow(1, {150, 75}, 0.3, 0.4))[0].visible_until, scene.Stamp(scene.seconds));
}

TEST_F(DepthTruthTest, VisibleUntilThePointIsOccluded) {
  TrackScene scene;
  scene.walls.push_back({Eigen::Vector3d(0, 0, 0.2), 1.0, 9.0});  // 5 m ahead, from x = 1 m on
  // The point is at x = 1 m on the far wall: hidden once the camera has come to 1 m, after 1 s.
  const events::Tracks track = scene.Follow(1, {110, 75}, 0.0, 2.0);
  const auto truth = Find(scene, track)[0];
  ASSERT_TRUE(truth.visible_until);
  const double until = ToSeconds(*truth.visible_until - testing::kSceneStart);
  EXPECT_GE(until, 0.94);
  EXPECT_LE(until, 1.01);
  EXPECT_FALSE(truth.positions.back());
  EXPECT_TRUE(truth.positions[90]);
}

/// Two px to the right of x = 119 begins a nearer wall, which moves twice as fast in the image.
TEST_F(DepthTruthTest, TracksAtADepthEdgeMayLieOnEitherSurface) {
  TrackScene scene;
  scene.walls.push_back({Eigen::Vector3d(0, 0, 0.2), 1.05, 9.0});  // 5 m ahead, seen from x = 121 on
  TrackScene near;
  near.walls = {{Eigen::Vector3d(0, 0, 0.2)}};
  const events::Tracks with_wall = near.Follow(1, {119, 75}, 0.0, 0.8);
  const auto truth = Find(scene, with_wall);
  ASSERT_EQ(truth[0].status, TrackStatus::kEvaluated);
  ASSERT_EQ(truth[0].other_surfaces.size(), 1u);
  for (std::size_t i = 0; i < with_wall.size(); ++i) {
    const Eigen::Vector2d seen(with_wall[i].x, with_wall[i].y);
    ASSERT_TRUE(truth[0].other_surfaces[0][i]) << i;
    EXPECT_LT((*truth[0].other_surfaces[0][i] - seen).norm(), kFloatPx) << i;
  }
  const auto accuracy =
      EvaluateTracks(GroupById(with_wall), truth, "depth", {0.5});  // the wall soon hides the point behind it
  EXPECT_EQ(accuracy.thresholds[0].median_exceeding_ratio, 1.0);
  EXPECT_EQ(accuracy.thresholds[0].false_track_ratio, 0.0);
  TrackTruthOptions narrow;
  narrow.surface_radius_px = 1.0;
  EXPECT_TRUE(Find(scene, with_wall, narrow)[0].other_surfaces.empty());
  EXPECT_TRUE(Find(scene, near.Follow(1, {110, 75}, 0.0, 0.8))[0].other_surfaces.empty()) << "far from the edge";
}

TEST_F(DepthTruthTest, TracksOnMovingObjectsAreNotEvaluated) {
  TrackScene scene;
  scene.walls.push_back({Eigen::Vector3d(0, 0, 0.2), 1.05, 9.0, true});
  events::Tracks tracks;
  for (const auto& [id, x] : {std::pair{1, 140.0}, {2, 119.0}, {3, 110.0}}) {  // on it, beside it, away from it
    const events::Tracks track = scene.Follow(id, {x, 75.0}, 0.0, 0.3);
    tracks.insert(tracks.end(), track.begin(), track.end());
  }
  const auto truth = Find(scene, tracks);
  EXPECT_EQ(truth[0].status, TrackStatus::kMovingObject);
  EXPECT_EQ(truth[1].status, TrackStatus::kMovingObject);
  EXPECT_EQ(truth[2].status, TrackStatus::kEvaluated);
}

TEST_F(DepthTruthTest, TracksWithoutDepthAreNotEvaluated) {
  TrackScene scene;
  scene.walls = {{Eigen::Vector3d(0, 0, 0.1), -2.0, 1e9}, {Eigen::Vector3d(0, 0, 0.2), 1.0, 9.0}};
  events::Tracks tracks;
  const auto add = [&](std::int64_t id, double x) {
    for (int i = 0; i < 5; ++i) tracks.push_back({id, scene.Stamp(0.01 * i), x, 75.0});
  };
  add(1, 60.0);   // beyond the end of the wall
  add(2, 119.5);  // on the edge between the two walls
  add(3, 300.0);  // off the sensor
  for (std::int64_t id = 4; id < 20; ++id) add(id, 90.0);
  const auto truth = Find(scene, tracks);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(truth[i].status, TrackStatus::kNoDepth) << i;
  EXPECT_EQ(truth[3].status, TrackStatus::kEvaluated);
  TrackTruthOptions lenient;
  lenient.depth_edge_ratio = 1.0;
  EXPECT_EQ(Find(scene, tracks, lenient)[1].status, TrackStatus::kEvaluated);
}

TEST_F(DepthTruthTest, OutsideTheTimeOfPosesAndMapsThereIsNoTruth) {
  const TrackScene scene;
  events::Tracks tracks{{1, testing::kSceneStart - kNsPerSecond, 90, 75}, {1, testing::kSceneStart, 90, 75}};
  EXPECT_EQ(Find(scene, tracks)[0].status, TrackStatus::kNoTruth);
  scene.WriteGroundTruth(path);
  TrackScene longer = scene;  // poses go on where the maps have ended
  longer.seconds = 4.0;
  tracks = longer.Follow(1, {90, 75}, 2.5, 3.0);
  const auto truth = TruthFromDepth(GroupById(tracks), longer.Poses(), scene.camera, io::DepthMapReader(path),
                                    kNsPerSecond, TrackTruthOptions());
  EXPECT_EQ(truth[0].status, TrackStatus::kNoDepth);
}

TEST_F(DepthTruthTest, RefusesMapsAndTracksOfAnotherCamera) {
  const TrackScene scene;
  scene.WriteGroundTruth(path);
  const auto kind = [&](const events::Tracks& tracks, const geometry::Camera& camera) {
    try {
      TruthFromDepth(GroupById(tracks), scene.Poses(), camera, io::DepthMapReader(path), kNsPerSecond,
                     TrackTruthOptions());
    } catch (const Error& error) {
      return error.exit_code();
    }
    return 0;
  };
  const events::Tracks track = scene.Follow(1, {90, 75}, 0.0, 0.5);
  EXPECT_EQ(kind(track, scene.camera), 0);
  EXPECT_EQ(kind(track, testing::MvsecCamera()), 4);
  events::Tracks off = track;
  for (auto& observation : off) observation.y += 200.0;
  EXPECT_EQ(kind(off, scene.camera), 4);
}

}  // namespace
}  // namespace evo::evaluation
