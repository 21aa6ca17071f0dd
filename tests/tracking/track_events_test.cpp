#include "evo/tracking/track_events.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "evo/core/error.hpp"
#include "tracking/track_all.hpp"

namespace evo::tracking {
namespace {

using Eigen::Vector2d;
using evo::tracking::testing::ById;
using evo::tracking::testing::CrossScene;
using evo::tracking::testing::Motion;
using evo::tracking::testing::TrackAll;
using evo::tracking::testing::TrackedStream;
using evo::tracking::testing::TracksById;

constexpr double kDuration = 0.6;

/// To the right with falling speed, then back to the left.
Vector2d ThereAndBack(double t) { return 0.6 / M_PI * std::sin(M_PI * t / 0.6) * Vector2d(150.0, 40.0); }

/// Errors of the displacement from the first to the last observation, of the tracks that span [`first_before_s`,
/// `last_after_s`] in a scene with this motion, px.
std::vector<Vector2d> Errors(const TracksById& tracks, const Motion& moved, double first_before_s,
                             double last_after_s) {
  std::vector<Vector2d> errors;
  for (const auto& [id, track] : tracks) {
    const auto &first = track.front(), &last = track.back();
    if (ToSeconds(first.t) > first_before_s || ToSeconds(last.t) < last_after_s) continue;
    errors.push_back(Vector2d(last.x - first.x, last.y - first.y) -
                     (moved(ToSeconds(last.t)) - moved(ToSeconds(first.t))));
  }
  return errors;
}

double MedianNorm(const std::vector<Vector2d>& errors) {
  std::vector<double> norms;
  for (const auto& error : errors) norms.push_back(error.norm());
  std::ranges::sort(norms);
  return norms[norms.size() / 2];
}

class TrackEventsTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    events = new events::EventColumns(CrossScene(75, 4).Events(ThereAndBack, kDuration, 1000.0));
    result = new TrackedStream(TrackAll(*events, {}, 1));
  }
  static void TearDownTestSuite() {
    delete events;
    delete result;
  }
  static events::EventColumns* events;
  static TrackedStream* result;
};

events::EventColumns* TrackEventsTest::events = nullptr;
TrackedStream* TrackEventsTest::result = nullptr;

TEST_F(TrackEventsTest, TracksFollowAReversal) {
  const std::vector<Vector2d> errors = Errors(ById(result->tracks), ThereAndBack, 0.3, 0.35);
  ASSERT_GE(errors.size(), 10u);
  Vector2d mean = Vector2d::Zero();
  for (const auto& error : errors) mean += error / static_cast<double>(errors.size());
  EXPECT_LT(MedianNorm(errors), 0.3);
  EXPECT_LT(mean.norm(), 0.4);
}

/// Motion that starts at `angle`, px.
struct DirectedMotion {
  const char* name;
  Motion motion;
};

/// Motions that stop, reverse, or turn by 90 degrees in the middle of `kDuration`.
std::vector<DirectedMotion> TurningMotions(double angle) {
  const Vector2d along(std::cos(angle), std::sin(angle));
  const Vector2d across(-along.y(), along.x());
  const double middle = 0.5 * kDuration;
  // Smooth speeds, whose integrals are known.
  const auto slows_down = [](double t) { return 0.6 / M_PI * std::sin(M_PI * t / 0.6); };
  return {{"reverses", [=](double t) -> Vector2d { return 120.0 * slows_down(t) * along; }},
          {"turns left",
           [=](double t) -> Vector2d {
             const double radius = 120.0 * 2.0 * kDuration / M_PI;
             const double turned = 0.5 * M_PI * t / kDuration;
             return radius * (std::sin(turned) * along + (1.0 - std::cos(turned)) * across);
           }},
          {"turns round",
           [=](double t) -> Vector2d {
             const double radius = 120.0 * kDuration / M_PI;
             const double turned = M_PI * t / kDuration;
             return radius * (std::sin(turned) * along + (1.0 - std::cos(turned)) * across);
           }},
          {"stops", [=](double t) -> Vector2d {
             const double moving = std::max(std::abs(t - middle) - 0.05, 0.0);
             return 120.0 * std::copysign(moving, t - middle) * along;
           }}};
}

TEST(TrackEvents, FollowsAMotionThatStopsReversesAndTurnsInEveryDirection) {
  std::map<std::string, std::vector<Vector2d>> errors_of;
  for (int direction = 0; direction < 8; ++direction) {
    for (const auto& [name, motion] : TurningMotions(0.25 * M_PI * direction + 0.1)) {
      const events::EventColumns events = CrossScene(75, 4).Events(motion, kDuration, 1000.0);
      for (const auto& error : Errors(ById(TrackAll(events, {}, 1).tracks), motion, 0.2, 0.45)) {
        errors_of[name].push_back(error);
      }
    }
  }
  EXPECT_EQ(errors_of.size(), 4u);
  for (const auto& [name, errors] : errors_of) {
    EXPECT_GE(errors.size(), 50u) << name;
    EXPECT_LT(MedianNorm(errors), 0.35) << name;
    EXPECT_LE(std::ranges::count_if(errors, [](const auto& e) { return e.norm() > 3.0; }), std::ssize(errors) / 20)
        << name;
  }
}

/// Median of the features' distances ahead of the nearest cross, along the scenes' constant velocity, px. Some features
/// are on the arms of a cross, hence the median.
double LeadOverCrosses(const Vector2d& velocity) {
  TrackerOptions options;
  options.uninformative_ratio = 0.0;  // to have many crosses
  std::vector<double> leads;
  for (unsigned seed = 4; seed < 12; ++seed) {
    const CrossScene scene(60, seed);
    const TrackedStream tracked =
        TrackAll(scene.Events([&](double t) { return Vector2d(velocity * (t - 0.2)); }, 0.4, 1000.0), options, 2);
    for (const auto& observation : tracked.tracks) {
      const Vector2d point = Vector2d(observation.x, observation.y) - velocity * (ToSeconds(observation.t) - 0.2);
      const auto nearest = std::ranges::min_element(
          scene.centres, {}, [&](const Vector2d& centre) { return (centre - point).squaredNorm(); });
      if ((*nearest - point).norm() < 6.0) leads.push_back((point - *nearest).dot(velocity.normalized()));
    }
  }
  EXPECT_GT(leads.size(), 800u);
  std::ranges::sort(leads);
  return leads.empty() ? 0.0 : leads[leads.size() / 2];
}

TEST(TrackEvents, PositionsAreThoseAtTheirStamp) {
  // Crosses are symmetric: positions that are late by 1 ms would lie 0.2 px behind them.
  for (const Vector2d& velocity : {Vector2d(200, 0), Vector2d(-200, 0), Vector2d(0, 200), Vector2d(0, -200)}) {
    EXPECT_LT(std::abs(LeadOverCrosses(velocity)), 0.15) << velocity.transpose();
  }
}

TEST(TrackEvents, FeaturesOutliveAStop) {
  // To the right, at rest from 0.5 s to 0.9 s: a resting scene causes no events.
  const auto moved = [](double t) {
    constexpr double kFast = 120.0;  // px/s
    const auto ramp = [](double s) { return s < 0.0 ? 0.0 : s < 0.2 ? 2.5 * s * s : 0.1 + s - 0.2; };
    return Vector2d(kFast * (t - ramp(t - 0.3) + ramp(t - 0.9)), 0.0);
  };
  std::vector<Vector2d> errors;
  for (unsigned seed = 4; seed < 12; ++seed) {
    const events::EventColumns all = CrossScene(60, seed).Events(moved, 1.2, 1000.0);
    events::EventColumns events;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double t = ToSeconds(all.t[i]);
      const double speed = (moved(t + 0.001) - moved(t - 0.001)).norm() / 0.002;
      if (speed > 10.0) events.push_back(all.t[i], all.x[i], all.y[i], all.polarity[i]);
    }
    const TracksById tracks = ById(TrackAll(events, {}, 2).tracks);
    for (const auto& error : Errors(tracks, moved, 0.4, 1.05)) errors.push_back(error);
    for (const auto& [id, track] : tracks) {
      if (ToSeconds(track.front().t) > 0.4 || ToSeconds(track.back().t) < 1.05) continue;
      for (std::size_t i = 1; i < track.size(); ++i) EXPECT_EQ(track[i].t - track[i - 1].t, FromSeconds(0.02));
    }
  }
  ASSERT_GE(errors.size(), 40u);
  EXPECT_LT(MedianNorm(errors), 0.2);
}

/// Errors of the tracks of eight scenes that span a bump, px.
std::vector<Vector2d> ErrorsOverABump(bool rotation_correction, double window_curvature_px) {
  // To the right at 40 px/s, and besides 22 px up within 60 ms and back within 160 ms.
  const auto moved = [](double t) {
    const double s = t - 0.3;
    const auto wave = [](double u) { return 0.5 - 0.5 * std::cos(M_PI * std::clamp(u, 0.0, 1.0)); };
    return Vector2d(40.0 * t, -22.0 * (wave(s / 0.06) - wave((s - 0.06) / 0.16)));
  };
  TrackerOptions options;
  options.rotation_correction = rotation_correction;
  options.window_curvature_px = window_curvature_px;
  options.uninformative_ratio = 0.0;  // to have many crosses
  std::vector<Vector2d> errors;
  for (unsigned seed = 6; seed < 14; ++seed) {
    const TrackedStream tracked = TrackAll(CrossScene(120, seed).Events(moved, 0.7, 1000.0), options, 2);
    for (const auto& error : Errors(ById(tracked.tracks), moved, 0.25, 0.6)) errors.push_back(error);
  }
  return errors;
}

double OutlierRatio(const std::vector<Vector2d>& errors) {
  const auto outliers = std::ranges::count_if(errors, [](const Vector2d& error) { return error.norm() > 1.0; });
  return static_cast<double>(outliers) / static_cast<double>(errors.size());
}

constexpr double kAnyCurvature = 1000.0;

TEST(TrackEvents, FeaturesFollowAnUnpredictedRotation) {
  const std::vector<Vector2d> errors = ErrorsOverABump(true, kAnyCurvature);
  EXPECT_GE(errors.size(), 100u);
  EXPECT_LE(OutlierRatio(errors), 0.02);
  // Without the correction they take a neighbour's pattern for their own.
  EXPECT_GE(OutlierRatio(ErrorsOverABump(false, kAnyCurvature)), 0.5);
}

TEST(TrackEvents, ShortWindowsKeepFeaturesInAnUnpredictedRotation) {
  for (const bool rotation_correction : {true, false}) {
    const std::vector<Vector2d> errors = ErrorsOverABump(rotation_correction, TrackerOptions().window_curvature_px);
    EXPECT_GE(errors.size(), 80u);
    EXPECT_LE(OutlierRatio(errors), 0.04);
  }
}

TEST_F(TrackEventsTest, MostTracksOutliveTheReversal) {
  std::map<std::int64_t, int> count;
  for (const auto& observation : result->tracks) ++count[observation.id];
  double frames = 0;
  for (const auto& [id, n] : count) frames += n;
  EXPECT_GT(frames / static_cast<double>(count.size()), 10.0);
}

TEST_F(TrackEventsTest, ObservationsAreSortedUniqueAndAtFrameStamps) {
  const std::set<TimeNs> frames(result->frames.begin(), result->frames.end());
  EXPECT_EQ(frames.size(), result->frames.size());
  for (std::size_t i = 0; i < result->tracks.size(); ++i) {
    EXPECT_TRUE(frames.contains(result->tracks[i].t));
    if (i == 0) continue;
    const auto key = [](const events::TrackObservation& o) { return std::pair(o.t, o.id); };
    EXPECT_LT(key(result->tracks[i - 1]), key(result->tracks[i]));
  }
  EXPECT_EQ(result->events, events->size());
}

TEST_F(TrackEventsTest, SameTracksForAnyNumberOfThreads) {
  const TrackedStream other = TrackAll(*events, {}, 3);
  ASSERT_EQ(other.tracks.size(), result->tracks.size());
  for (std::size_t i = 0; i < other.tracks.size(); ++i) {
    EXPECT_EQ(other.tracks[i].id, result->tracks[i].id);
    EXPECT_EQ(other.tracks[i].x, result->tracks[i].x);
    EXPECT_EQ(other.tracks[i].y, result->tracks[i].y);
  }
}

TEST_F(TrackEventsTest, AHotPixelIsNoFeature) {
  events::EventColumns hot;
  for (TimeNs t = 0; t < 600'000'000; t += 100'000) hot.push_back(t, 60, 45, t % 200'000 ? 1 : -1);
  EXPECT_TRUE(TrackAll(hot, {}).tracks.empty());
}

TEST(TrackEvents, ThrowsIfTheEventsSpanFewerThanTwoFrames) {
  events::EventColumns few;
  few.push_back(0, 1, 1, 1);
  few.push_back(1000, 2, 2, 1);
  try {
    TrackAll(few, {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kNothingToDo);
  }
}

}  // namespace
}  // namespace evo::tracking
