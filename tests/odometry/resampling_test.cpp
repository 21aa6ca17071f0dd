#include "evo/odometry/resampling.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "odometry/synthetic_drive.hpp"

namespace evo::odometry {
namespace {

/// A track that moves along x.
struct LinearTrack {
  std::int64_t id = 0;
  double speed = 0.0;  // px/s
  double interval_s = 0.003;
  double begin_s = 0.0;
  double end_s = 1.0;
  bool quantised = false;  // to whole pixels
};

/// Observes a track at random instants about its interval apart.
void AddTrack(const LinearTrack& track, std::mt19937* random, events::Tracks* tracks) {
  std::uniform_real_distribution<double> jitter(0.5, 1.5);
  for (double t = track.begin_s; t < track.end_s; t += track.interval_s * jitter(*random)) {
    const double x = 20.0 + track.speed * t;
    tracks->push_back({track.id, FromSeconds(t), track.quantised ? std::round(x) : x, 50.0});
  }
}

void Sort(events::Tracks* tracks) {
  std::ranges::sort(*tracks, {}, [](const events::TrackObservation& o) { return std::pair(o.t, o.id); });
}

TEST(Resampling, DistinguishesFramesFromAsynchronousTracks) {
  EXPECT_TRUE(AreSynchronous(testing::MakeDrive({.seconds = 0.5}).tracks));
  std::mt19937 random(1);
  events::Tracks tracks;
  for (int id = 0; id < 50; ++id)
    AddTrack({.id = id, .speed = 100, .interval_s = 0.002, .end_s = 0.5}, &random, &tracks);
  Sort(&tracks);
  EXPECT_FALSE(AreSynchronous(tracks));
}

TEST(Resampling, IsExactForLinearMotionAndDoesNotExtrapolate) {
  std::mt19937 random(2);
  events::Tracks tracks;
  for (int id = 0; id < 20; ++id) AddTrack({.id = id, .speed = 80, .begin_s = 0.01 * id}, &random, &tracks);
  Sort(&tracks);
  const events::Tracks resampled = Resample(tracks, {});
  ASSERT_GT(resampled.size(), 500u);
  for (const auto& o : resampled) {
    EXPECT_NEAR(o.x, 20.0 + 80.0 * ToSeconds(o.t), 1e-6);
    EXPECT_GE(ToSeconds(o.t), 0.01 * static_cast<double>(o.id) - 1e-9);
    EXPECT_LT(ToSeconds(o.t), 1.0);
  }
  EXPECT_TRUE(std::ranges::is_sorted(resampled, {}, [](const auto& o) { return std::pair(o.t, o.id); }));
  EXPECT_TRUE(AreSynchronous(resampled));
}

TEST(Resampling, FittedLineBeatsInterpolationOfQuantisedPositions) {
  std::mt19937 random(3);
  events::Tracks tracks;
  for (int id = 0; id < 20; ++id)
    AddTrack({.id = id, .speed = 300.0 + id, .interval_s = 0.002, .quantised = true}, &random, &tracks);
  Sort(&tracks);
  const auto rms = [&](double window) {
    double sum = 0.0;
    const events::Tracks resampled = Resample(tracks, {.fit_window_s = window});
    for (const auto& o : resampled) {
      sum += std::pow(o.x - (20.0 + (300.0 + static_cast<double>(o.id)) * ToSeconds(o.t)), 2);
    }
    return std::sqrt(sum / static_cast<double>(resampled.size()));
  };
  EXPECT_LT(rms(0.01), 0.7 * rms(0.0));
}

TEST(Resampling, DoesNotInterpolateLongGaps) {
  std::mt19937 random(4);
  events::Tracks tracks;
  AddTrack({.id = 1, .speed = 50, .end_s = 0.4}, &random, &tracks);
  AddTrack({.id = 1, .speed = 50, .begin_s = 0.8, .end_s = 1.2}, &random, &tracks);
  for (const auto& o : Resample(tracks, {.max_gap_s = 0.2})) {
    EXPECT_TRUE(ToSeconds(o.t) < 0.41 || ToSeconds(o.t) > 0.79) << ToSeconds(o.t);
  }
}

TEST(Resampling, SkipsAGapOfManyYears) {
  const TimeNs late = 1'000'000'000 * kNsPerSecond;
  const TimeNs ms = 1'000'000;
  const events::Tracks tracks{{1, 0, 5, 5}, {1, 50 * ms, 5, 5}, {1, late, 6, 5}, {1, late + 50 * ms, 6, 5}};
  const events::Tracks resampled = Resample(tracks, {.frame_interval_s = 0.025});
  ASSERT_EQ(resampled.size(), 6u);
  EXPECT_EQ(resampled[2].t, 50 * ms);
  EXPECT_EQ(resampled[3].t, late);
}

}  // namespace
}  // namespace evo::odometry
