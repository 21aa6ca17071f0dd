#include "evo/evaluation/track_accuracy.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "evo/core/error.hpp"

namespace evo::evaluation {
namespace {

/// Tracks whose truth stands still at (50, 60), with errors along x that a test chooses.
struct Made {
  std::vector<FeatureTrack> tracks;
  std::vector<TrueTrack> truth;

  /// Position number i is `interval_s` * i after the start and off by `error(i)`.
  void Add(int count, double interval_s, const std::function<double(int)>& error, double true_lifetime_s = NAN) {
    const auto id = static_cast<std::int64_t>(tracks.size());
    tracks.push_back({id, {}});
    truth.push_back(
        {.status = TrackStatus::kEvaluated, .positions = {}, .other_surfaces = {}, .visible_until = std::nullopt});
    for (int i = 0; i < count; ++i) {
      tracks.back().observations.push_back({id, FromSeconds(interval_s * i), 50.0 + error(i), 60.0});
      truth.back().positions.emplace_back(Eigen::Vector2d(50.0, 60.0));
    }
    if (std::isfinite(true_lifetime_s)) truth.back().visible_until = FromSeconds(true_lifetime_s);
  }

  TrackAccuracy Evaluate(const std::vector<double>& thresholds) const {
    return EvaluateTracks(tracks, truth, "tracks", thresholds);
  }
};

double Zero(int) { return 0.0; }

TEST(TrackAccuracy, PerfectTracksHaveNoErrorAndReachTheirTrueAge) {
  Made made;
  made.Add(11, 0.1, Zero, 1.0);
  made.Add(21, 0.1, Zero, 2.0);
  const auto accuracy = made.Evaluate({3.0, 1.0});
  ASSERT_EQ(accuracy.thresholds.size(), 3u);
  EXPECT_EQ(accuracy.thresholds_px, (std::vector<double>{1.0, 3.0}));
  for (const auto& threshold : accuracy.thresholds) {
    EXPECT_EQ(threshold.error_px.count, 32);
    EXPECT_EQ(threshold.error_px.max, 0.0);
    EXPECT_EQ(threshold.exceeding_ratio, 0.0);
    EXPECT_EQ(threshold.outlier_ratio, 0.0);
    EXPECT_DOUBLE_EQ(threshold.feature_age_s.mean, 1.5);
    EXPECT_DOUBLE_EQ(threshold.expected_age_s, 1.5);
    EXPECT_DOUBLE_EQ(threshold.expected_age_normalized, 1.0);
  }
  EXPECT_DOUBLE_EQ(accuracy.expected_age_normalized, 1.0);
}

TEST(TrackAccuracy, ConstantOffsetIsTheError) {
  Made made;
  made.Add(50, 0.02, [](int) { return -2.5; });
  const auto accuracy = made.Evaluate({2.0, 3.0});
  const auto& within = accuracy.thresholds[1];
  for (const double value :
       {within.error_px.mean, within.error_px.median, within.error_px.rmse, within.error_quantiles_px.p25,
        within.error_quantiles_px.p99, within.track_error_mean_px, within.track_error_median_px}) {
    EXPECT_DOUBLE_EQ(value, 2.5);
  }
  EXPECT_EQ(accuracy.thresholds[0].outlier_ratio, 1.0);
  EXPECT_EQ(accuracy.thresholds[0].error_px.count, 0);
  EXPECT_TRUE(std::isnan(accuracy.thresholds[0].feature_age_s.mean));
  EXPECT_EQ(accuracy.thresholds[0].expected_age_s, 0.0);
  EXPECT_TRUE(std::isnan(within.expected_age_normalized));  // no true lifetime
}

TEST(TrackAccuracy, LinearDriftEndsTheFeatureAgeWhereItCrossesTheThreshold) {
  Made made;
  made.Add(
      301, 0.01, [](int i) { return 0.03 * i; }, 4.0);  // 3 px/s over 3 s
  const auto accuracy = made.Evaluate({5.0});
  const auto& at_5px = accuracy.thresholds[0];
  EXPECT_NEAR(at_5px.feature_age_s.mean, 1.66, 1e-9);  // the last stamp before 5/3 s
  EXPECT_NEAR(at_5px.expected_age_normalized, 1.66 / 4.0, 1e-9);
  EXPECT_EQ(at_5px.error_px.count, 167);
  EXPECT_NEAR(at_5px.error_px.mean, 0.5 * 3.0 * 1.66, 1e-9);
  EXPECT_NEAR(at_5px.error_px.max, 4.98, 1e-9);
  EXPECT_EQ(at_5px.exceeding_ratio, 1.0);
  EXPECT_EQ(at_5px.outlier_ratio, 0.0);
  EXPECT_NEAR(accuracy.thresholds[1].error_px.max, 9.0, 1e-9);
  EXPECT_NEAR(accuracy.tracks[0].feature_ages_s[0], 1.66, 1e-9);
}

TEST(TrackAccuracy, TheFeatureAgeEndsAtTheFirstExcess) {
  Made made;
  made.Add(10, 0.1, [](int i) { return i == 4 ? 6.0 : 0.5; });
  const auto accuracy = made.Evaluate({5.0});
  EXPECT_NEAR(accuracy.thresholds[0].feature_age_s.mean, 0.3, 1e-12);
  EXPECT_EQ(accuracy.thresholds[0].error_px.count, 4);
  EXPECT_EQ(accuracy.thresholds[1].error_px.count, 10);
}

TEST(TrackAccuracy, ExpectedAgeIsTheAgeOfStableTracksTimesTheirRatio) {
  Made made;
  made.Add(11, 0.1, Zero, 2.0);  // half of its true life
  made.Add(
      11, 0.1, [](int i) { return 100.0 * i; }, 1.0);  // jumps away at once
  made.Add(
      11, 0.1, [](int) { return 20.0; }, 1.0);  // was never there
  made.Add(
      6, 0.1, [](int i) { return i < 3 ? 0.0 : 9.0; }, 0.5);
  const auto at_5px = made.Evaluate({5.0}).thresholds[0];
  EXPECT_DOUBLE_EQ(at_5px.outlier_ratio, 0.5);
  EXPECT_DOUBLE_EQ(at_5px.exceeding_ratio, 0.75);
  EXPECT_DOUBLE_EQ(at_5px.median_exceeding_ratio, 0.5) << "the last one is off in half of its positions only";
  EXPECT_NEAR(at_5px.feature_age_s.mean, 0.6, 1e-12);
  EXPECT_NEAR(at_5px.feature_age_s.median, 0.6, 1e-12);
  EXPECT_NEAR(at_5px.expected_age_s, 0.3, 1e-12);
  EXPECT_NEAR(at_5px.expected_age_normalized, (0.5 + 0.0 + 0.0 + 0.4) / 4.0, 1e-12);
}

TEST(TrackAccuracy, AFalseTrackFollowsNoSurface) {
  Made made;
  for (int i = 0; i < 4; ++i) made.Add(11, 0.1, [](int k) { return 1.0 * k; });  // 5.5 px off at the median
  made.Add(11, 0.1, Zero);
  const auto beside = [&](std::size_t track, double off_px, std::size_t known) {
    auto& positions = made.truth[track].other_surfaces.emplace_back(11);
    for (std::size_t i = 0; i < known; ++i) {
      const auto& seen = made.tracks[track].observations[i];
      positions[i] = Eigen::Vector2d(seen.x, seen.y + off_px);
    }
  };
  beside(0, 1.0, 11);  // follows this one
  beside(1, 4.0, 11);  // nearer to this one, but does not follow it either
  beside(1, 9.0, 11);
  beside(2, 0.0, 5);  // the point leaves the image early
  const auto accuracy = made.Evaluate({3.0});
  EXPECT_DOUBLE_EQ(accuracy.thresholds[0].median_exceeding_ratio, 0.8);
  EXPECT_DOUBLE_EQ(accuracy.thresholds[0].false_track_ratio, 0.6);
  EXPECT_DOUBLE_EQ(accuracy.tracks[0].surface_error_px, 1.0);
  EXPECT_DOUBLE_EQ(accuracy.tracks[1].surface_error_px, 4.0);
  EXPECT_DOUBLE_EQ(accuracy.tracks[2].surface_error_px, 5.0);
  EXPECT_DOUBLE_EQ(accuracy.tracks[4].surface_error_px, 0.0);
  EXPECT_GT(accuracy.thresholds[0].error_px.max, 2.9) << "the other errors are those from the track's own point";
}

TEST(TrackAccuracy, NormalizedExpectedAgeIsTheMeanOverThresholdsOf1To31Px) {
  Made made;
  made.Add(
      41, 0.1, [](int i) { return i - 0.5; }, 4.0);  // at T px its age is T / 10 s
  EXPECT_NEAR(made.Evaluate({5.0}).expected_age_normalized, 16.0 / 40.0, 1e-9);
}

TEST(TrackAccuracy, ThePositionThatDefinesTheTruthIsNotCompared) {
  Made made;
  made.Add(4, 0.1, [](int i) { return i == 0 ? 0.0 : 2.0; });
  made.truth[0].starts_at_observation = true;
  const auto accuracy = made.Evaluate({5.0});
  EXPECT_EQ(accuracy.thresholds[0].error_px.count, 3);
  EXPECT_DOUBLE_EQ(accuracy.thresholds[0].error_px.mean, 2.0);
  EXPECT_NEAR(accuracy.thresholds[0].feature_age_s.mean, 0.3, 1e-12);  // the age begins with it all the same
}

TEST(TrackAccuracy, TheAgeStartsWithTheFirstKnownTruth) {
  Made made;
  made.Add(10, 0.1, Zero, 1.1);
  for (std::size_t i = 0; i < 3; ++i) made.truth[0].positions[i].reset();
  const auto accuracy = made.Evaluate({5.0});
  EXPECT_NEAR(accuracy.thresholds[0].feature_age_s.mean, 0.6, 1e-12);
  EXPECT_NEAR(*accuracy.tracks[0].true_lifetime_s, 0.8, 1e-12);
  EXPECT_NEAR(accuracy.tracks[0].lifetime_s, 0.9, 1e-12);
  EXPECT_EQ(accuracy.tracks[0].observations, 10);
}

TEST(TrackAccuracy, CountsTracksByStatus) {
  Made made;
  made.Add(5, 0.1, Zero);
  made.Add(1, 0.1, Zero);
  for (const auto verdict :
       {TrackStatus::kNoDepth, TrackStatus::kMovingObject, TrackStatus::kNoTruth, TrackStatus::kNotTriangulated}) {
    made.Add(5, 0.1, [](int) { return 1e3; });
    made.truth.back().status = verdict;
  }
  const auto accuracy = made.Evaluate({5.0});
  for (const auto verdict : {TrackStatus::kEvaluated, TrackStatus::kTooShort, TrackStatus::kNoDepth,
                             TrackStatus::kMovingObject, TrackStatus::kNoTruth, TrackStatus::kNotTriangulated}) {
    EXPECT_EQ(Count(accuracy, verdict), 1);
  }
  EXPECT_EQ(accuracy.thresholds[1].error_px.max, 0.0);
}

TEST(TrackAccuracy, ErrorOverAgeHasQuartilesOfEveryPosition) {
  Made made;
  for (int track = 0; track < 5; ++track) {
    made.Add(41, 0.1, [&](int i) { return track + (i < 20 ? 0.0 : 10.0); });
  }
  const auto bins = made.Evaluate({1.0}).error_over_age;
  ASSERT_EQ(bins.size(), 21u);  // 0.2 s each
  std::int64_t positions = 0;
  for (const auto& bin : bins) {
    EXPECT_NEAR(bin.high_s - bin.low_s, 0.2, 1e-12);
    EXPECT_EQ(bin.tracks, 5);
    const double shift = bin.low_s < 1.9 ? 0.0 : 10.0;
    EXPECT_DOUBLE_EQ(bin.p25_px, 1.0 + shift) << bin.low_s;
    EXPECT_DOUBLE_EQ(bin.median_px, 2.0 + shift);
    EXPECT_DOUBLE_EQ(bin.p75_px, 3.0 + shift);
    positions += bin.positions;
  }
  EXPECT_EQ(positions, 205);
}

ErrorKind KindOfRefusal(const Made& made, const std::vector<double>& thresholds) {
  try {
    made.Evaluate(thresholds);
  } catch (const Error& error) {
    return error.kind();
  }
  ADD_FAILURE() << "nothing was refused";
  return ErrorKind::kOutput;
}

TEST(TrackAccuracy, RefusesInvalidThresholds) {
  Made made;
  made.Add(5, 0.1, Zero);
  for (const double bad : {0.0, -1.0, static_cast<double>(NAN), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(KindOfRefusal(made, {1.0, bad}), ErrorKind::kUsage) << bad;
  }
  EXPECT_EQ(KindOfRefusal(made, {}), ErrorKind::kUsage);
}

TEST(TrackAccuracy, WithoutEvaluatedTracksTheErrorNamesTheReasons) {
  Made made;
  made.Add(5, 0.1, Zero);
  made.truth[0].status = TrackStatus::kNoDepth;
  EXPECT_EQ(KindOfRefusal(made, {5.0}), ErrorKind::kNothingToDo);
  EXPECT_EQ(KindOfRefusal({}, {5.0}), ErrorKind::kNothingToDo);
}

}  // namespace
}  // namespace evo::evaluation
