#include "tracking/baseline/klt_tracker.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "evo/core/error.hpp"
#include "tracking/track_all.hpp"

namespace evo::tracking {
namespace {

using Eigen::Vector2d;
using evo::tracking::testing::ById;
using evo::tracking::testing::CrossScene;
using evo::tracking::testing::TrackAll;
using evo::tracking::testing::TrackedStream;

constexpr int kAnyNumber = 1'000'000;

/// Images of the newest `events`, none older than `max_window_s`.
TrackerOptions KltWith(int events, double max_window_s) {
  TrackerOptions options;
  options.method = "klt";
  options.klt.events = events;
  options.klt.max_window_s = max_window_s;
  return options;
}

TEST(KltTracker, FollowsASceneThatReverses) {
  const auto shift = [](double t) -> Vector2d { return 0.6 / M_PI * std::sin(M_PI * t / 0.6) * Vector2d(150, 40); };
  const TrackedStream result = TrackAll(CrossScene(75, 4).Events(shift, 0.6, 1000.0), KltWith(kAnyNumber, 0.02));
  std::vector<double> errors;
  for (const auto& [id, track] : ById(result.tracks)) {
    const auto& [first, last] = std::pair(track.front(), track.back());
    if (ToSeconds(first.t) > 0.2 || ToSeconds(last.t) < 0.5) continue;
    // The images show the scene half a window ago.
    const Vector2d moved = shift(ToSeconds(last.t) - 0.01) - shift(ToSeconds(first.t) - 0.01);
    errors.push_back((Vector2d(last.x - first.x, last.y - first.y) - moved).norm());
  }
  ASSERT_GE(errors.size(), 10U);
  std::ranges::sort(errors);
  EXPECT_LT(errors[errors.size() / 2], 0.7);
}

/// Mean lag of the positions behind the crosses of a scene of constant speed, s.
double MeanLag(const events::EventColumns& events, const CrossScene& scene, double speed,
               const TrackerOptions& options) {
  double sum = 0.0;
  int count = 0;
  for (const auto& observation : TrackAll(events, options).tracks) {
    if (ToSeconds(observation.t) < 0.1) continue;  // the first images lack events
    const Vector2d point(observation.x - speed * ToSeconds(observation.t), observation.y);
    const auto nearest =
        std::ranges::min_element(scene.centres, {}, [&](const Vector2d& c) { return (c - point).squaredNorm(); });
    if ((*nearest - point).norm() > 7.0) continue;
    sum += (nearest->x() - point.x()) / speed;
    ++count;
  }
  EXPECT_GT(count, 50);
  return sum / std::max(1, count);
}

TEST(KltTracker, PositionsLagByHalfAWindow) {
  const CrossScene scene(60, 4);
  for (const double speed : {150.0, -150.0}) {
    const events::EventColumns events = scene.Events([&](double t) { return Vector2d(speed * t, 0); }, 0.4, 1000.0);
    EXPECT_NEAR(MeanLag(events, scene, speed, KltWith(kAnyNumber, 0.01)), 0.005, 0.002);
    EXPECT_NEAR(MeanLag(events, scene, speed, KltWith(kAnyNumber, 0.03)), 0.015, 0.002);
    const double rate_hz = static_cast<double>(events.size()) / 0.4;
    EXPECT_NEAR(MeanLag(events, scene, speed, KltWith(3000, 0.1)), 0.5 * 3000 / rate_hz, 0.002);
  }
}

TEST(KltTracker, NoTrackOutlivesAChangeOfScene) {
  const auto rest = [](double) -> Vector2d { return Vector2d::Zero(); };
  events::EventColumns events = CrossScene(75, 4).Events(rest, 0.3);
  const events::EventColumns other = CrossScene(75, 5).Events(rest, 0.3);
  for (std::size_t i = 0; i < other.size(); ++i) {
    events.push_back(other.t[i] + FromSeconds(0.3), other.x[i], other.y[i], other.polarity[i]);
  }
  int before = 0;
  int both = 0;
  for (const auto& [id, track] : ById(TrackAll(events, KltWith(kAnyNumber, 0.02)).tracks)) {
    if (ToSeconds(track.front().t) > 0.2) continue;
    ++before;
    if (ToSeconds(track.back().t) > 0.4) ++both;
  }
  EXPECT_GE(before, 10);
  EXPECT_LE(both, before / 5);
}

TEST(KltTracker, TracksDoNotDependOnTheNumberOfThreads) {
  const events::EventColumns events =
      CrossScene(75, 4).Events([](double t) { return Vector2d(120 * t, 30 * t); }, 0.4, 1000.0);
  const events::Tracks one = TrackAll(events, KltWith(3000, 0.1), 1).tracks;
  const events::Tracks three = TrackAll(events, KltWith(3000, 0.1), 3).tracks;
  ASSERT_GT(one.size(), 100U);
  const auto same = [](const events::TrackObservation& a, const events::TrackObservation& b) {
    return a.id == b.id && a.t == b.t && a.x == b.x && a.y == b.y;
  };
  EXPECT_TRUE(std::ranges::equal(one, three, same));
}

TEST(TrackerOptions, RefusesInvalidMethodsAndImages) {
  TrackerOptions options;
  Parameters parameters;
  Register(parameters, options);
  parameters.Set("tracker.method=klt");
  EXPECT_EQ(options.method, "klt");
  for (const char* setting :
       {"tracker.method=KLT", "tracker.method=", "tracker.klt.events=0", "tracker.klt.max_window_s=0",
        "tracker.klt.patch_radius_px=1", "tracker.klt.forward_backward_px=nan", "tracker.klt.levels=3"}) {
    try {
      parameters.Set(setting);
      ADD_FAILURE() << setting;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kConfiguration) << setting;
    }
  }
}

}  // namespace
}  // namespace evo::tracking
