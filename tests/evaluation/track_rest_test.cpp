#include "evo/evaluation/track_rest.hpp"

#include <gtest/gtest.h>

namespace evo::evaluation {
namespace {

constexpr TimeNs kFrame = 20'000'000;  // ns

/// `tracks` with a speed along x (px/s) in `frames` frames from `first` on, with ids from `id` on.
void AddTracks(std::int64_t id, int tracks, double speed, int first, int frames, std::vector<events::Tracks>* stream) {
  for (int k = 0; k < frames; ++k) {
    const TimeNs t = (first + k) * kFrame;
    if (stream->size() <= static_cast<std::size_t>(first + k)) stream->resize(first + k + 1);
    for (int i = 0; i < tracks; ++i) {
      (*stream)[first + k].push_back({id + i, t, 20.0 + speed * ToSeconds(k * kFrame), 10.0});
    }
  }
}

RestStatistics Measure(const std::vector<events::Tracks>& stream) {
  RestCounter counter;
  for (const auto& frame : stream) counter.Add(frame);
  return counter.Statistics();
}

TEST(RestCounterTest, NothingRestsWithoutTracks) {
  EXPECT_EQ(RestCounter().Statistics().observations, 0u);
  EXPECT_EQ(RestCounter().Statistics().ratio, 0.0);
}

TEST(RestCounterTest, CountsObservationsOfSlowTracks) {
  std::vector<events::Tracks> stream;
  AddTracks(0, 3, 60.0, 0, 40, &stream);
  AddTracks(10, 1, 5.0, 0, 40, &stream);
  const RestStatistics statistics = Measure(stream);
  EXPECT_EQ(statistics.observations, 160u);
  EXPECT_NEAR(statistics.ratio, 0.25, 1e-9);
  EXPECT_NEAR(statistics.moving_ratio, 0.25, 1e-9);
}

TEST(RestCounterTest, ShortTracksTellNothing) {
  std::vector<events::Tracks> stream;
  AddTracks(0, 3, 60.0, 0, 40, &stream);
  AddTracks(10, 5, 0.0, 0, kMinRestFrames - 1, &stream);
  EXPECT_EQ(Measure(stream).ratio, 0.0);
  AddTracks(20, 1, 0.0, 40, kMinRestFrames, &stream);
  EXPECT_GT(Measure(stream).ratio, 0.0);
}

TEST(RestCounterTest, StandingCameraIsNotAnAnomaly) {
  std::vector<events::Tracks> stream;
  AddTracks(0, 20, 80.0, 0, 50, &stream);
  AddTracks(100, 20, 0.0, 50, 50, &stream);
  const RestStatistics statistics = Measure(stream);
  EXPECT_NEAR(statistics.ratio, 0.5, 1e-9);
  EXPECT_EQ(statistics.moving_ratio, 0.0);
}

TEST(RestCounterTest, NoiseInMostTracksIsSeen) {
  std::vector<events::Tracks> stream;
  AddTracks(0, 30, 80.0, 0, 100, &stream);
  AddTracks(100, 70, 1.0, 0, 100, &stream);
  EXPECT_NEAR(Measure(stream).moving_ratio, 0.7, 1e-9);
}

TEST(RestCounterTest, PartsOfTheStreamDoNotMatter) {
  std::vector<events::Tracks> stream;
  AddTracks(0, 3, 60.0, 0, 90, &stream);
  AddTracks(10, 2, 1.0, 20, 50, &stream);
  AddTracks(20, 1, 0.0, 60, 30, &stream);
  RestCounter counter;
  events::Tracks part;
  for (std::size_t i = 0; i < stream.size(); ++i) {
    part.insert(part.end(), stream[i].begin(), stream[i].end());
    if (i % 7 != 0) continue;
    counter.Add(part);
    part.clear();
  }
  counter.Add(part);
  EXPECT_NEAR(counter.Statistics().ratio, Measure(stream).ratio, 1e-12);
  EXPECT_NEAR(counter.Statistics().moving_ratio, Measure(stream).moving_ratio, 1e-12);
}

}  // namespace
}  // namespace evo::evaluation
