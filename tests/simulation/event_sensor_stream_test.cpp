#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <vector>

#include "evo/core/error.hpp"
#include "simulation/sensor/event_sensor.hpp"
#include "simulation/sensor_stimulus.hpp"

// Tiles, stamps and errors of the sensor's stream of events.

namespace evo::simulation {
namespace {

using test::Show;

constexpr TimeNs kMs = 1'000'000;
constexpr TimeNs kUs = 1'000;

using SortedEvents = std::vector<std::tuple<int, int, TimeNs, int>>;

SortedEvents DefaultSensorEvents(std::uint64_t seed, int tile, bool backwards, double readout_row_s = 0.0) {
  SensorOptions options;
  options.hot_pixels = options.dead_pixels = 0.01;
  options.shot_noise_hz = 5.0;
  options.readout_row_s = readout_row_s;
  Show show(75, 41, options, seed, tile);
  if (backwards) std::reverse(show.tiles.begin(), show.tiles.end());
  show.Run(0, 300 * kMs, 3 * kMs, [](int x, int y, double t) {
    return static_cast<float>(0.5 + 0.45 * std::sin(0.4 * x + 0.1 * y - 40 * t));
  });
  SortedEvents sorted;
  const events::EventColumns& e = show.events;
  for (std::size_t i = 0; i < e.size(); ++i) sorted.emplace_back(e.y[i], e.x[i], e.t[i], e.polarity[i]);
  // Stable by pixel only: the order in time within a pixel is the sensor's.
  std::ranges::stable_sort(sorted, {}, [](const auto& v) { return std::pair(std::get<0>(v), std::get<1>(v)); });
  return sorted;
}

TEST(EventSensor, EventsDoNotDependOnSizeAndOrderOfTheTiles) {
  const SortedEvents expected = DefaultSensorEvents(3, 75, false);
  ASSERT_GT(expected.size(), 10'000U);
  EXPECT_EQ(DefaultSensorEvents(3, 75, false), expected);
  EXPECT_EQ(DefaultSensorEvents(3, 32, false), expected);
  EXPECT_EQ(DefaultSensorEvents(3, 7, true), expected);
  EXPECT_EQ(DefaultSensorEvents(3, 1, true), expected);
  EXPECT_NE(DefaultSensorEvents(4, 75, false), expected);
}

TEST(EventSensor, StampsAreWholeMicrosecondsInOrder) {
  for (const double readout : {0.0, 0.0013}) {
    const SortedEvents events = DefaultSensorEvents(3, 32, false, readout);
    for (std::size_t i = 0; i < events.size(); ++i) {
      const auto [y, x, t, sign] = events[i];
      ASSERT_EQ(t % kUs, 0);
      ASSERT_GE(t, 0);
      ASSERT_LE(t, 300 * kMs + FromSeconds(readout));
      if (i == 0 || std::get<0>(events[i - 1]) != y || std::get<1>(events[i - 1]) != x) continue;
      ASSERT_LE(std::get<2>(events[i - 1]), t);
    }
  }
}

TEST(EventSensor, RowsAreStampedWhenTheyAreRead) {
  const SortedEvents at_once = DefaultSensorEvents(3, 32, false);
  const SortedEvents read = DefaultSensorEvents(3, 32, false, 0.001);
  ASSERT_EQ(read.size(), at_once.size());
  std::map<int, TimeNs> phase;
  double mean_delay_us = 0.0;
  for (std::size_t i = 0; i < read.size(); ++i) {
    const auto [y, x, t, sign] = read[i];
    const TimeNs delay = t - std::get<2>(at_once[i]);
    EXPECT_GE(delay, 0);
    EXPECT_LE(delay, kMs);
    EXPECT_EQ(phase.try_emplace(y, t % kMs).first->second, t % kMs) << "row " << y;
    mean_delay_us += ToSeconds(delay) * 1e6 / static_cast<double>(read.size());
  }
  EXPECT_NEAR(mean_delay_us, 500.0, 30.0);
}

TEST(EventSensor, BadInputIsAnError) {
  const SensorOptions options;
  EXPECT_THROW(EventSensor(0, 10, options, 1), Error);
  EXPECT_THROW(EventSensor(10, 70'000, options, 1), Error);
  EventSensor sensor(4, 2, options, 1);
  events::EventColumns events;
  const Tile tile{0, 0, 4, 2};
  const std::vector<float> fine(8, 0.5F);
  sensor.Advance(tile, 0, fine, &events);
  EXPECT_THROW(sensor.Advance(tile, 0, fine, &events), Error);
  EXPECT_THROW(sensor.Advance(tile, -5, fine, &events), Error);
  EXPECT_THROW(sensor.Advance({1, 0, 4, 2}, 5, fine, &events), Error);
  EXPECT_THROW(sensor.Advance({0, -1, 4, 2}, 5, fine, &events), Error);
  EXPECT_THROW(sensor.Advance(tile, 5, std::vector<float>(7, 0.5F), &events), Error);
  for (const float bad : {-0.1F, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    std::vector<float> radiance = fine;
    radiance[5] = bad;
    EXPECT_THROW(sensor.Advance(tile, 5, radiance, &events), Error) << bad;
  }
  EXPECT_NO_THROW(sensor.Advance(tile, 5, std::vector<float>(8, 0.0F), &events));
}

}  // namespace
}  // namespace evo::simulation
