#include "events/flicker/flicker_filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>
#include <tuple>
#include <vector>

namespace evo::events {
namespace {

constexpr int kWidth = 64;
constexpr int kHeight = 48;
constexpr TimeNs kSample = 100'000;
constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;

/// Pixels with thresholds of their own that see log radiance as a function of place and time, sampled every 100 us.
class Sensor {
 public:
  double threshold_on = 0.25;
  double threshold_off = 0.25;
  double mismatch = 0.0;  ///< standard deviation over the mean
  TimeNs refractory = 300'000;
  double jitter_s = 0.0;

  template <typename LogRadiance>
  EventColumns Record(double duration_s, const LogRadiance& log_radiance) const {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    std::vector<double> on(kPixels), off(kPixels), level(kPixels);
    std::vector<TimeNs> ready(kPixels, 0);
    for (std::size_t p = 0; p < kPixels; ++p) {
      on[p] = threshold_on * std::exp(mismatch * normal(random));
      off[p] = threshold_off * std::exp(mismatch * normal(random));
      level[p] = log_radiance(static_cast<int>(p % kWidth), static_cast<int>(p / kWidth), 0.0);
    }
    std::vector<std::tuple<TimeNs, int, int, int>> events;
    for (TimeNs t = 0; t < FromSeconds(duration_s); t += kSample) {
      for (std::size_t p = 0; p < kPixels; ++p) {
        if (t < ready[p]) continue;
        const int x = static_cast<int>(p % kWidth);
        const int y = static_cast<int>(p / kWidth);
        const double change = log_radiance(x, y, ToSeconds(t)) - level[p];
        if (change < on[p] && change > -off[p]) continue;
        level[p] += change > 0.0 ? on[p] : -off[p];
        ready[p] = t + refractory;
        events.emplace_back(t + FromSeconds(jitter_s * uniform(random)), x, y, change > 0.0 ? 1 : -1);
      }
    }
    std::ranges::sort(events);
    EventColumns columns;
    for (const auto& [t, x, y, polarity] : events) {
      columns.push_back(t, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y),
                        static_cast<std::int8_t>(polarity));
    }
    return columns;
  }
};

/// Log of light that flickers, up to `depth` of its mean.
double LogFlicker(double depth, double frequency_hz, double t) {
  return std::log(1.0 + depth * std::sin(2.0 * std::numbers::pi * frequency_hz * t));
}

/// A soft edge of contrast 1 at column `at`.
double Edge(double x, double at) { return 1.0 / (1.0 + std::exp(-2.0 * (x - at))); }

struct Filtered {
  EventColumns events;
  FlickerStatistics statistics;
};

/// Applies the filter to blocks of this many events.
Filtered Filter(const EventColumns& events, std::size_t block_size, const FlickerOptions& options = {}) {
  FlickerFilter filter(kWidth, kHeight, options);
  Filtered filtered;
  const auto append = [&](const EventColumns& block) {
    for (std::size_t i = 0; i < block.size(); ++i) {
      filtered.events.push_back(block.t[i], block.x[i], block.y[i], block.polarity[i]);
    }
  };
  for (std::size_t begin = 0; begin < events.size(); begin += block_size) {
    EventColumns block;
    for (std::size_t i = begin; i < std::min(begin + block_size, events.size()); ++i) {
      block.push_back(events.t[i], events.x[i], events.y[i], events.polarity[i]);
    }
    filter.Apply(&block);
    append(block);
  }
  EventColumns rest;
  filter.Finish(&rest);
  append(rest);
  filtered.statistics = filter.statistics();
  return filtered;
}

bool AreEqual(const EventColumns& a, const EventColumns& b) {
  return a.t == b.t && a.x == b.x && a.y == b.y && a.polarity == b.polarity;
}

std::size_t CountIf(const EventColumns& events, const auto& condition) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < events.size(); ++i) count += condition(i) ? 1 : 0;
  return count;
}

/// Flicker alone, of several frequencies and depths, with unequal thresholds.
class FlickerAlone : public testing::TestWithParam<std::tuple<double, double>> {};

TEST_P(FlickerAlone, Vanishes) {
  const auto [frequency_hz, depth] = GetParam();
  Sensor sensor;
  sensor.threshold_on = 0.3;
  sensor.threshold_off = 0.15;
  sensor.mismatch = 0.1;
  sensor.jitter_s = 2e-4;
  const EventColumns events =
      sensor.Record(1.0, [&](int, int, double t) { return LogFlicker(depth, frequency_hz, t); });
  const Filtered filtered = Filter(events, 10'000);
  EXPECT_NEAR(filtered.statistics.frequency_hz, frequency_hz, 0.01 * frequency_hz);
  EXPECT_EQ(filtered.statistics.flicker_events, events.size());
  EXPECT_LT(static_cast<double>(filtered.events.size()), 0.01 * static_cast<double>(events.size()));
}

INSTANTIATE_TEST_SUITE_P(FrequencyAndDepth, FlickerAlone,
                         testing::Values(std::tuple{100.0, 0.3}, std::tuple{100.0, 0.97}, std::tuple{120.0, 0.8},
                                         std::tuple{217.0, 0.8}));

/// An edge moves at 60 px/s through light that flickers.
TEST(FlickerFilter, ALongSilenceIsBridged) {
  Sensor sensor;
  EventColumns events = sensor.Record(1.0, [](int, int, double t) { return LogFlicker(0.8, 100.0, t); });
  const std::size_t count = events.size();
  for (std::size_t i = 0; i < count; ++i) {
    events.push_back(events.t[i] + FromSeconds(1e6), events.x[i], events.y[i], events.polarity[i]);
  }
  const Filtered filtered = Filter(events, 10'000);
  EXPECT_GT(filtered.statistics.flicker_events, events.size() * 9 / 10);
  EXPECT_TRUE(std::ranges::is_sorted(filtered.events.t));
}

TEST(FlickerFilter, KeepsAnEdgeAtItsTime) {
  const auto edge_at = [](double t) { return 2.0 + 60.0 * t; };
  Sensor sensor;
  sensor.mismatch = 0.1;
  sensor.jitter_s = 2e-4;
  const EventColumns steady = sensor.Record(1.0, [&](int x, int, double t) { return 2.0 * Edge(x, edge_at(t)); });
  const EventColumns flickering =
      sensor.Record(1.0, [&](int x, int, double t) { return 2.0 * Edge(x, edge_at(t)) + LogFlicker(0.8, 100.0, t); });
  const Filtered filtered = Filter(flickering, 10'000);
  ASSERT_GT(flickering.size(), 100 * steady.size());
  // The distance of the events from the edge, and the number of events elsewhere.
  struct Distance {
    double mean, rms;
    std::size_t near, elsewhere;
  };
  const auto measure = [&](const EventColumns& events) {
    double sum = 0.0;
    double square = 0.0;
    std::size_t near = 0;
    for (std::size_t i = 0; i < events.size(); ++i) {
      const double d = events.x[i] - edge_at(ToSeconds(events.t[i]));
      if (std::abs(d) > 4.0 || events.polarity[i] > 0) continue;
      ++near;
      sum += d;
      square += d * d;
    }
    const auto n = static_cast<double>(near);
    return Distance{sum / n, std::sqrt(square / n), near, events.size() - near};
  };
  const Distance truth = measure(steady);
  const Distance found = measure(filtered.events);
  // While a pixel's thresholds are being learned, its edge is lost. A sensor fires half a threshold after the middle.
  EXPECT_NEAR(static_cast<double>(found.near), static_cast<double>(truth.near), 0.3 * static_cast<double>(truth.near));
  EXPECT_NEAR(found.mean, truth.mean, 0.25);
  EXPECT_LT(found.rms, truth.rms + 0.3);
  EXPECT_LT(found.elsewhere, flickering.size() / 200);
}

/// Flicker on the left half, an edge on the right one.
TEST(FlickerFilter, LeavesOtherPlacesAlone) {
  const Sensor sensor;
  const EventColumns events = sensor.Record(1.0, [](int x, int, double t) {
    return x < kWidth / 2 ? LogFlicker(0.8, 100.0, t) : 2.0 * Edge(x, 34.0 + 25.0 * t);
  });
  const Filtered filtered = Filter(events, 5000);
  const auto right = [](const EventColumns& all) {
    std::vector<std::tuple<TimeNs, int, int, int>> part;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all.x[i] >= kWidth / 2) part.emplace_back(all.t[i], all.x[i], all.y[i], all.polarity[i]);
    }
    std::ranges::sort(part);
    return part;
  };
  EXPECT_EQ(right(filtered.events), right(events));
  EXPECT_LT(CountIf(filtered.events, [&](std::size_t i) { return filtered.events.x[i] < kWidth / 2; }),
            events.size() / 100);
  EXPECT_NEAR(filtered.statistics.tile_ratio, 0.5, 0.01);
}

/// A pattern that moves at 300 px/s past the pixels, each of which sees it at 100 Hz: a fence.
TEST(FlickerFilter, LeavesAMovingPatternAlone) {
  const Sensor sensor;
  const EventColumns events =
      sensor.Record(1.0, [](int x, int, double t) { return std::sin(2.0 * std::numbers::pi * (x - 300.0 * t) / 3.0); });
  ASSERT_GT(events.size(), 10'000U);
  EXPECT_TRUE(AreEqual(Filter(events, 10'000).events, events));
}

/// Simulators that render frames give events of both signs at the frames' times.
TEST(FlickerFilter, LeavesNoiseFramesAndHotPixelsAlone) {
  std::mt19937 random(5);
  EventColumns events;
  for (TimeNs t = 0; t < 1'500'000'000; t += 20'000) {
    if (t % 10'000'000 == 0) {
      for (int k = 0; k < 600; ++k) {
        events.push_back(t, static_cast<std::uint16_t>(random() % kWidth),
                         static_cast<std::uint16_t>(random() % kHeight), random() % 3 == 0 ? 1 : -1);
      }
      for (std::uint16_t y = 3; y < kHeight; y += 7) events.push_back(t, y, y, 1);
    }
    events.push_back(t, static_cast<std::uint16_t>(random() % kWidth), static_cast<std::uint16_t>(random() % kHeight),
                     random() % 2 == 0 ? 1 : -1);
  }
  EXPECT_TRUE(AreEqual(Filter(events, 10'000).events, events));
}

TEST(FlickerFilter, DoesNotDependOnTheBlocks) {
  const Sensor sensor;
  const EventColumns events = sensor.Record(0.7, [](int x, int y, double t) {
    const double lamp = x + y < 50 && t > 0.2 ? LogFlicker(0.9, 120.0, t) : 0.0;
    return lamp + Edge(x, 50.0 * t) + Edge(y, 40.0 * t);
  });
  const Filtered whole = Filter(events, events.size());
  EXPECT_GT(whole.statistics.flicker_events, 0U);
  EXPECT_TRUE(std::ranges::is_sorted(whole.events.t));
  for (const std::size_t block_size : {777U, 20'000U}) {
    EXPECT_TRUE(AreEqual(Filter(events, block_size).events, whole.events)) << block_size;
  }
}

TEST(FlickerFilter, CanBeSwitchedOff) {
  const Sensor sensor;
  const EventColumns events = sensor.Record(0.5, [](int, int, double t) { return LogFlicker(0.8, 100.0, t); });
  EXPECT_TRUE(AreEqual(Filter(events, 10'000, {.remove = false}).events, events));
}

}  // namespace
}  // namespace evo::events
