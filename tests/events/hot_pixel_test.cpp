#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <set>
#include <utility>

#include "events/noise_stream.hpp"
#include "evo/events/filtered_event_reader.hpp"

namespace evo::events {
namespace {

constexpr int kWidth = 40;
constexpr int kHeight = 30;

struct Outcome {
  std::map<std::pair<int, int>, HotPixel> hot;
  EventColumns kept;
  FilterStatistics statistics;

  bool IsHot(int x, int y) const { return hot.contains({x, y}); }
  std::size_t KeptOf(int x, int y, double from_s = 0.0, double to_s = 1e9) const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < kept.size(); ++i) {
      count += kept.x[i] == x && kept.y[i] == y && kept.t[i] >= FromSeconds(from_s) && kept.t[i] < FromSeconds(to_s);
    }
    return count;
  }
};

Outcome Filter(const EventColumns& events, std::size_t block_size = 5000, const IgnoredPixels& ignored = {},
               bool detect = true) {
  EventFilterOptions options;
  options.hot_pixels.detect = detect;
  FilteredEventReader reader(std::make_unique<VectorReader>(events, block_size), kWidth, kHeight, options, ignored);
  Outcome outcome;
  EventColumns block;
  while (reader.Next(&block)) {
    EXPECT_FALSE(block.empty());
    for (std::size_t i = 0; i < block.size(); ++i) {
      outcome.kept.push_back(block.t[i], block.x[i], block.y[i], block.polarity[i]);
    }
  }
  for (const HotPixel& pixel : reader.hot_pixels()) outcome.hot[{pixel.x, pixel.y}] = pixel;
  outcome.statistics = reader.statistics();
  return outcome;
}

/// Shot noise of 2 Hz and a stripe that passes at 60 px/s: each pixel has about 11 events/s.
NoiseStream BusyScene(double to_s, unsigned seed = 1) {
  NoiseStream stream(seed);
  stream.AddShotNoise(kWidth, kHeight, to_s, 2.0);
  stream.AddStripe(kWidth, kHeight, to_s, 60.0, 6);
  return stream;
}

TEST(HotPixels, NoneInABusyScene) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const EventColumns events = BusyScene(6.0, seed).Sorted();
    const Outcome outcome = Filter(events);
    EXPECT_TRUE(outcome.hot.empty());
    EXPECT_EQ(outcome.kept.t, events.t);
    EXPECT_EQ(outcome.kept.x, events.x);
    EXPECT_EQ(outcome.kept.y, events.y);
    EXPECT_EQ(outcome.kept.polarity, events.polarity);
  }
}

TEST(HotPixels, AreLeftOutFromTheFirstEventOn) {
  for (const double rate : {100.0, 200.0, 300.0}) {
    NoiseStream stream = BusyScene(4.0);
    stream.AddPoisson(17, 12, 0.0, 4.0, rate);
    stream.AddPoisson(0, 0, 0.0, 4.0, rate);
    stream.AddPoisson(kWidth - 1, 20, 0.0, 4.0, rate);
    const Outcome outcome = Filter(stream.Sorted());
    EXPECT_EQ(outcome.hot.size(), 3U) << rate;
    EXPECT_EQ(outcome.KeptOf(17, 12) + outcome.KeptOf(0, 0) + outcome.KeptOf(kWidth - 1, 20), 0U) << rate;
  }
}

TEST(HotPixels, SlowOnesAreFoundWithinSeconds) {
  for (const double rate : {25.0, 40.0, 60.0}) {
    NoiseStream stream = BusyScene(8.0);
    stream.AddPoisson(17, 12, 0.0, 8.0, rate);
    const Outcome outcome = Filter(stream.Sorted());
    EXPECT_TRUE(outcome.IsHot(17, 12)) << rate;
    EXPECT_EQ(outcome.KeptOf(17, 12, 5.0), 0U) << rate;
  }
}

TEST(HotPixels, OfOnePolarityAndPeriodic) {
  NoiseStream stream = BusyScene(3.0);
  for (double t = 0.003; t < 3.0; t += 0.0125) stream.Add(t, 20, 20, 1);
  const Outcome outcome = Filter(stream.Sorted());
  EXPECT_TRUE(outcome.IsHot(20, 20));
  EXPECT_EQ(outcome.hot.size(), 1U);
}

TEST(HotPixels, NeighboursAreBothFound) {
  NoiseStream stream = BusyScene(6.0);
  stream.AddPoisson(17, 12, 0.0, 6.0, 80.0);
  stream.AddPoisson(18, 13, 0.0, 6.0, 120.0);
  const Outcome outcome = Filter(stream.Sorted());
  EXPECT_TRUE(outcome.IsHot(17, 12));
  EXPECT_TRUE(outcome.IsHot(18, 13));
  EXPECT_EQ(outcome.hot.size(), 2U);
}

TEST(HotPixels, ThatComeAndGo) {
  NoiseStream stream = BusyScene(24.0);
  for (const double on : {2.0, 4.0, 15.0, 17.0, 22.0}) stream.AddPoisson(17, 12, on, on + 1.0, 120.0);
  const Outcome outcome = Filter(stream.Sorted());
  ASSERT_TRUE(outcome.IsHot(17, 12));
  // About 250 events belong to the scene.
  EXPECT_LT(outcome.KeptOf(17, 12), 300U);
  EXPECT_LT(outcome.KeptOf(17, 12, 15.0, 16.0), 30U);
}

TEST(HotPixels, VibratingEdgeIsNone) {
  // Each pixel along the edge sees a sinusoid with its own amplitude and thresholds; some are alone above theirs.
  NoiseStream stream(5);
  stream.AddShotNoise(kWidth, kHeight, 6.0, 0.2);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int y = 0; y < kHeight; ++y) {
    const double amplitude = 0.11 + 0.1 * uniform(stream.random());
    double reference = 0.0;
    for (double t = 0.0; t < 6.0; t += 0.0005) {
      const double level = amplitude * std::sin(2.0 * std::numbers::pi * 28.0 * t);
      if (level > reference + 0.2) {
        stream.Add(t, 20, y, 1);
        reference += 0.2;
      } else if (level < reference - 0.1) {
        stream.Add(t, 20, y, -1);
        reference -= 0.1;
      }
    }
  }
  EXPECT_TRUE(Filter(stream.Sorted()).hot.empty());
}

TEST(HotPixels, FlickeringLampIsNone) {
  // Three pixels square, twice 100 times a second, and it moves by 2 px/s.
  NoiseStream stream(6);
  stream.AddShotNoise(kWidth, kHeight, 8.0, 1.0);
  std::uniform_real_distribution<double> jitter(0.0, 0.0005);
  for (double t = 0.0; t < 8.0; t += 0.005) {
    const int left = 10 + static_cast<int>(2.0 * t);
    const int sign = std::lround(t / 0.005) % 2 == 0 ? 1 : -1;
    for (int k = 0; k < 9; ++k) stream.Add(t + jitter(stream.random()), left + k % 3, 10 + k / 3, sign);
  }
  EXPECT_TRUE(Filter(stream.Sorted()).hot.empty());
}

TEST(HotPixels, SlowDotIsNone) {
  NoiseStream stream(7);
  stream.AddShotNoise(kWidth, kHeight, 10.0, 1.0);
  for (int x = 5; x < 30; ++x) {
    const double enter = (x - 5) / 2.5;  // 2.5 px/s
    for (int k = 0; k < 10; ++k) {
      stream.Add(enter + 0.02 * k, x, 15, 1);
      stream.Add(enter + 0.4 + 0.02 * k, x, 15, -1);
    }
  }
  EXPECT_TRUE(Filter(stream.Sorted()).hot.empty());
}

TEST(HotPixels, DoNotDependOnTheBlocks) {
  NoiseStream stream = BusyScene(5.0);
  stream.AddPoisson(17, 12, 1.0, 3.0, 90.0);
  stream.AddPoisson(30, 5, 0.0, 5.0, 30.0);
  const EventColumns events = stream.Sorted();
  const Outcome whole = Filter(events, events.size());
  ASSERT_EQ(whole.hot.size(), 2U);
  for (const std::size_t block : {1UL, 777UL, 20000UL}) {
    const Outcome cut = Filter(events, block);
    EXPECT_EQ(cut.kept.t, whole.kept.t);
    EXPECT_EQ(cut.kept.x, whole.kept.x);
  }
}

TEST(HotPixels, SilenceIsBridged) {
  NoiseStream stream = BusyScene(2.0);
  stream.AddPoisson(17, 12, 0.0, 2.0, 100.0);
  stream.AddPoisson(17, 12, 1e6, 1e6 + 2.0, 100.0);
  EXPECT_EQ(Filter(stream.Sorted()).hot.size(), 1U);
}

TEST(EventFilters, MaskAndKnownPixelsAreLeftOut) {
  NoiseStream stream = BusyScene(2.0);
  stream.AddPoisson(17, 12, 0.0, 2.0, 100.0);
  const EventColumns events = stream.Sorted();
  IgnoredPixels ignored;
  ignored.masked.assign(kWidth * kHeight, 0);
  for (int i = 20 * kWidth; i < kHeight * kWidth; ++i) ignored.masked[static_cast<std::size_t>(i)] = 1;
  ignored.hot = {12 * kWidth + 17, 3 * kWidth + 4};
  const Outcome outcome = Filter(events, 5000, ignored, false);
  EXPECT_EQ(outcome.statistics.events, events.size());
  EXPECT_EQ(outcome.statistics.masked_pixels, 10U * kWidth);
  EXPECT_EQ(outcome.kept.size() + outcome.statistics.masked_events + outcome.statistics.hot_events, events.size());
  EXPECT_EQ(outcome.KeptOf(17, 12), 0U);
  EXPECT_EQ(outcome.KeptOf(4, 3), 0U);
  EXPECT_EQ(outcome.hot.size(), 2U);
  for (std::size_t i = 0; i < outcome.kept.size(); ++i) ASSERT_LT(outcome.kept.y[i], 20);
}

TEST(EventFilters, DetectionCanBeSwitchedOff) {
  NoiseStream stream = BusyScene(2.0);
  stream.AddPoisson(17, 12, 0.0, 2.0, 100.0);
  const EventColumns events = stream.Sorted();
  EXPECT_EQ(Filter(events, 5000, {}, false).kept.size(), events.size());
}

TEST(EventFilters, EmptyStreamEnds) {
  const Outcome outcome = Filter({});
  EXPECT_TRUE(outcome.kept.empty());
  EXPECT_EQ(outcome.statistics.events, 0U);
}

}  // namespace
}  // namespace evo::events
