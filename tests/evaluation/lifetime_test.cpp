#include "evo/evaluation/lifetime.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace evo::evaluation {
namespace {

constexpr TimeNs kFrame = 25'000'000;

std::vector<TimeNs> FrameStamps(int count) {
  std::vector<TimeNs> stamps;
  for (int i = 0; i < count; ++i) stamps.push_back(i * kFrame);
  return stamps;
}

void Append(events::Tracks* tracks, std::int64_t id, int first_frame, int frames) {
  for (int i = 0; i < frames; ++i) tracks->push_back({id, (first_frame + i) * kFrame, 1.0 * i, 2.0});
}

events::Tracks Sorted(events::Tracks tracks) {
  std::ranges::sort(tracks, {}, [](const events::TrackObservation& o) { return std::tuple(o.t, o.id); });
  return tracks;
}

TEST(Lifetime, CountsFramesAndSecondsOfLongTracks) {
  events::Tracks tracks;
  Append(&tracks, 1, 0, 3);
  Append(&tracks, 2, 2, 5);
  Append(&tracks, 3, 4, 10);
  Append(&tracks, 4, 1, 2);   // too short
  Append(&tracks, 5, 19, 1);  // too short
  const auto statistics = ComputeLifetimes(Sorted(tracks), FrameStamps(20));
  EXPECT_EQ(statistics.frames, 20);
  EXPECT_EQ(statistics.tracks, 3);
  EXPECT_EQ(statistics.tracks_too_short, 2);
  EXPECT_EQ(statistics.tracks_censored, 0);
  EXPECT_DOUBLE_EQ(statistics.in_frames.mean, 6.0);
  EXPECT_DOUBLE_EQ(statistics.in_frames.median, 5.0);
  EXPECT_DOUBLE_EQ(statistics.in_frames.max, 10.0);
  EXPECT_DOUBLE_EQ(statistics.in_frames.standard_deviation, std::sqrt((9.0 + 1.0 + 16.0) / 3.0));
  EXPECT_DOUBLE_EQ(statistics.in_seconds.mean, (2 + 4 + 9) * 0.025 / 3.0);
  EXPECT_DOUBLE_EQ(statistics.in_seconds.max, 0.225);
}

TEST(Lifetime, PartsGiveTheSameAsTheWhole) {
  events::Tracks tracks;
  for (int i = 0; i < 300; ++i) Append(&tracks, i, i / 2, 1 + i % 40);
  tracks = Sorted(tracks);
  const auto stamps = FrameStamps(static_cast<int>(tracks.back().t / kFrame) + 1);
  const auto whole = ComputeLifetimes(tracks, stamps);
  LifetimeCounter counter;
  for (std::size_t i = 0, end = 0; i < tracks.size(); i = end) {
    while (end < tracks.size() && tracks[end].t <= tracks[i].t + 3 * kFrame) ++end;
    counter.Add(std::span(tracks).subspan(i, end - i));
    counter.EndBefore(tracks[end - 1].t);
  }
  const auto parts = counter.Statistics(stamps);
  EXPECT_GT(whole.tracks_censored, 0);
  EXPECT_EQ(parts.tracks, whole.tracks);
  EXPECT_EQ(parts.tracks_too_short, whole.tracks_too_short);
  EXPECT_EQ(parts.tracks_censored, whole.tracks_censored);
  EXPECT_EQ(parts.in_frames.mean, whole.in_frames.mean);
  EXPECT_EQ(parts.in_seconds.standard_deviation, whole.in_seconds.standard_deviation);
  EXPECT_EQ(parts.in_seconds.median, whole.in_seconds.median);
  ASSERT_EQ(parts.histogram.size(), whole.histogram.size());
  for (std::size_t i = 0; i < parts.histogram.size(); ++i) {
    EXPECT_EQ(parts.histogram[i].tracks, whole.histogram[i].tracks);
  }
}

TEST(Lifetime, BinsInSecondsHoldEquallyManyLifetimes) {
  events::Tracks tracks;
  for (int i = 0; i < 120; ++i) Append(&tracks, i, 0, 3 + i);  // one track for each lifetime of 2 to 121 intervals
  const auto statistics = ComputeLifetimes(Sorted(tracks), FrameStamps(130));
  EXPECT_DOUBLE_EQ(statistics.frame_interval_s, 0.025);
  const auto& bins = statistics.histogram_seconds;
  ASSERT_EQ(bins.size(), 25u);  // of 5 intervals
  for (std::size_t i = 0; i < bins.size(); ++i) {
    EXPECT_NEAR(bins[i].low, 0.125 * static_cast<double>(i), 1e-12);
    EXPECT_NEAR(bins[i].high, bins[i].low + 0.125, 1e-12);
    EXPECT_EQ(bins[i].tracks, i == 0 ? 3 : i + 1 < bins.size() ? 5 : 2) << i;
  }
}

TEST(Lifetime, NeedsNoFramesForSeconds) {
  const events::Tracks tracks{{1, 0, 0, 0}, {1, 3, 0, 0}, {1, 700'000'003, 0, 0}};
  const auto statistics = ComputeLifetimes(tracks, {});
  EXPECT_EQ(statistics.frame_interval_s, 0.0);
  ASSERT_FALSE(statistics.histogram_seconds.empty());
  EXPECT_LE(statistics.histogram_seconds.size(), 60u);
  EXPECT_EQ(statistics.histogram_seconds.back().tracks, 1);
}

TEST(Lifetime, MedianOfAnEvenCountIsTheMeanOfTheMiddleTwo) {
  events::Tracks tracks;
  Append(&tracks, 1, 0, 4);
  Append(&tracks, 2, 0, 7);
  EXPECT_DOUBLE_EQ(ComputeLifetimes(Sorted(tracks), FrameStamps(10)).in_frames.median, 5.5);
}

TEST(Lifetime, CountsCensoredTracks) {
  events::Tracks tracks;
  Append(&tracks, 1, 0, 5);
  Append(&tracks, 2, 5, 5);
  EXPECT_EQ(ComputeLifetimes(Sorted(tracks), FrameStamps(10)).tracks_censored, 1);
}

TEST(Lifetime, HistogramIsContiguousAndHoldsEveryTrackOnce) {
  for (const int longest : {3, 62, 63, 120, 700, 5000}) {
    events::Tracks tracks;
    Append(&tracks, 0, 0, longest);
    for (int i = 1; i <= 40; ++i) Append(&tracks, i, 0, 3 + (i * 37) % (longest - 2));
    const auto statistics = ComputeLifetimes(Sorted(tracks), FrameStamps(longest));
    const auto& bins = statistics.histogram;
    ASSERT_FALSE(bins.empty());
    EXPECT_LE(bins.size(), 60u);
    EXPECT_EQ(bins.front().low, kMinLifetimeFrames);
    EXPECT_LT(bins.back().low, longest + 1);
    EXPECT_GT(bins.back().high, longest);
    for (std::size_t i = 1; i < bins.size(); ++i) EXPECT_EQ(bins[i].low, bins[i - 1].high);
    const auto total = std::accumulate(bins.begin(), bins.end(), std::int64_t{0},
                                       [](std::int64_t sum, const LifetimeBin& bin) { return sum + bin.tracks; });
    EXPECT_EQ(total, statistics.tracks);
  }
}

TEST(Lifetime, NoTracksIsNotAnError) {
  const auto statistics = ComputeLifetimes({}, FrameStamps(4));
  EXPECT_EQ(statistics.tracks, 0);
  EXPECT_EQ(statistics.in_frames.mean, 0.0);
  EXPECT_TRUE(statistics.histogram.empty());
}

}  // namespace
}  // namespace evo::evaluation
