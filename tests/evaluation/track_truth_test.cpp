#include "evo/evaluation/track_truth.hpp"

#include <gtest/gtest.h>

#include <random>

#include "evaluation/track_scene.hpp"
#include "evo/core/error.hpp"
#include "evo/evaluation/track_accuracy.hpp"

namespace evo::evaluation {
namespace {

using testing::TrackScene;

constexpr TimeNs kMs = 1'000'000;

TEST(TrackTruth, GroupsByIdInOrderOfTime) {
  const auto grouped = GroupById({{7, 0, 1, 1}, {2, 1, 2, 2}, {7, 1, 3, 3}, {7, 5, 4, 4}});
  ASSERT_EQ(grouped.size(), 2u);
  EXPECT_EQ(grouped[0].id, 2);
  EXPECT_EQ(grouped[1].id, 7);
  ASSERT_EQ(grouped[1].observations.size(), 3u);
  EXPECT_EQ(grouped[1].observations[2].t, 5);
}

TEST(TrackTruth, TrueTracksAreInterpolatedWithinGapsOnly) {
  const events::Tracks truth{{1, 100 * kMs, 10, 20}, {1, 200 * kMs, 20, 40}, {1, 900 * kMs, 30, 40}};
  const events::Tracks tracks{{1, 50 * kMs, 0, 0},  {1, 100 * kMs, 0, 0}, {1, 130 * kMs, 0, 0},
                              {1, 500 * kMs, 0, 0}, {1, 900 * kMs, 0, 0}, {1, 901 * kMs, 0, 0}};
  const auto result = TruthFromTracks(GroupById(tracks), truth, 500 * kMs)[0];
  EXPECT_EQ(result.status, TrackStatus::kEvaluated);
  EXPECT_FALSE(result.starts_at_observation);
  EXPECT_EQ(result.visible_until, 900 * kMs);
  const auto& p = result.positions;
  EXPECT_TRUE(!p[0] && p[1] && p[2] && !p[3] && p[4] && !p[5]);
  EXPECT_TRUE(p[1]->isApprox(Eigen::Vector2d(10, 20)));
  EXPECT_TRUE(p[2]->isApprox(Eigen::Vector2d(13, 26)));
}

TEST(TrackTruth, TracksWithoutATrueTrackHaveNoTruth) {
  const auto tracks = GroupById({{1, 0, 5, 5}, {2, 0, 5, 5}, {3, 700 * kMs, 5, 5}});
  const auto result = TruthFromTracks(tracks, {{1, 0, 5, 5}, {3, 0, 5, 5}}, kNsPerSecond);
  EXPECT_EQ(result[0].status, TrackStatus::kEvaluated);
  EXPECT_EQ(result[1].status, TrackStatus::kNoTruth);
  EXPECT_EQ(result[2].status, TrackStatus::kNoTruth);
}

std::vector<TrueTrack> Triangulate(const TrackScene& scene, const events::Tracks& tracks) {
  return TruthFromTriangulation(GroupById(tracks), scene.Poses(), scene.camera, kNsPerSecond);
}

TEST(TrackTruth, TriangulationFindsThePointOfAPerfectTrack) {
  TrackScene scene;
  scene.camera = testing::MvsecCamera();
  scene.turning = {0.0, 0.1, 0.05};
  const events::Tracks track = scene.Follow(1, {250.0, 60.0}, 0.013, 0.9);
  const auto truth = Triangulate(scene, track)[0];
  EXPECT_EQ(truth.status, TrackStatus::kEvaluated);
  EXPECT_FALSE(truth.visible_until);
  for (std::size_t i = 0; i < track.size(); ++i) {
    EXPECT_LT((*truth.positions[i] - Eigen::Vector2d(track[i].x, track[i].y)).norm(), 1e-6);
  }
}

TEST(TrackTruth, TriangulationResidualsAreTheNoiseMinusThreeDegreesOfFreedom) {
  const TrackScene scene;
  constexpr double kSigma = 0.4;
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, kSigma);
  std::uniform_real_distribution<double> where(40.0, 140.0);
  events::Tracks tracks;
  for (int id = 0; id < 400; ++id) {
    for (auto observation : scene.Follow(id, {where(random), where(random)}, 0.0, 0.2)) {
      observation.x += noise(random);
      observation.y += noise(random);
      tracks.push_back(observation);
    }
  }
  const auto grouped = GroupById(tracks);
  const auto accuracy = EvaluateTracks(grouped, Triangulate(scene, tracks), "triangulated", {5.0});
  const double n = static_cast<double>(grouped[0].observations.size());
  const double expected = kSigma * std::sqrt((2.0 * n - 3.0) / n);  // of both coordinates
  EXPECT_NEAR(accuracy.thresholds.back().error_px.rmse / expected, 1.0, 0.02);
  EXPECT_GE(Count(accuracy, TrackStatus::kEvaluated), 390);
}

TEST(TrackTruth, TriangulationIsBlindToDriftAlongTheMotionAndSeesItAcross) {
  const TrackScene scene;
  events::Tracks along = scene.Follow(1, {150.0, 75.0}, 0.0, 1.0);
  events::Tracks across = along;
  for (std::size_t i = 0; i < along.size(); ++i) {
    along[i].x += 0.02 * static_cast<double>(i);
    across[i].y += 0.02 * static_cast<double>(i);
  }
  const auto rmse = [&](const events::Tracks& tracks) {
    return EvaluateTracks(GroupById(tracks), Triangulate(scene, tracks), "triangulated", {5.0})
        .thresholds.back()
        .error_px.rmse;
  };
  EXPECT_LT(rmse(along), 1e-6);
  EXPECT_GT(rmse(across), 0.5);
}

TEST(TrackTruth, NeedsParallaxAndPosesToTriangulate) {
  TrackScene still;
  still.velocity.setZero();
  EXPECT_EQ(Triangulate(still, still.Follow(1, {90, 75}, 0.0, 1.0))[0].status, TrackStatus::kNotTriangulated);
  const TrackScene scene;
  EXPECT_EQ(Triangulate(scene, scene.Follow(1, {90, 75}, 0.0, 0.01))[0].status, TrackStatus::kTooShort);
  EXPECT_EQ(Triangulate(scene, {{1, 0, 90, 75}, {1, kMs, 90, 75}})[0].status, TrackStatus::kNoTruth);
}

TEST(TrackTruth, TracksOfAnotherSensorAreRefused) {
  const TrackScene scene;
  try {
    Triangulate(scene, {{1, scene.Stamp(0), 90, 200}, {1, scene.Stamp(0.1), 90, 201}});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInput);
    EXPECT_NE(std::string(error.what()).find("2 of 2 track positions"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace evo::evaluation
