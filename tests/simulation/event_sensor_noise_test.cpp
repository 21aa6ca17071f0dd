#include <gtest/gtest.h>

#include <cmath>

#include "simulation/sensor/event_sensor.hpp"
#include "simulation/sensor_stimulus.hpp"

// Noise against its expectations, and the sensor as it comes.

namespace evo::simulation {
namespace {

using test::ByPixel;
using test::CountOf;
using test::IdealSensor;
using test::RadianceOfLog;
using test::Show;

constexpr TimeNs kMs = 1'000'000;

TEST(SensorNoise, LeakEventsArePositiveAndHaveTheirRate) {
  SensorOptions options = IdealSensor(0.3, 0.2);
  options.leak_hz = 2.0;
  Show show(20, 20, options);
  show.Run(0, 10'000 * kMs, 40 * kMs, [](int, int, double) { return 0.5F; });
  EXPECT_EQ(CountOf(show.events, -1), 0);
  EXPECT_NEAR(CountOf(show.events, 1), 20 * 20 * 10 * 2, 400);
  std::vector<double> first;
  for (const auto& [pixel, events] : ByPixel(show.events)) {
    first.push_back(ToSeconds(events.t.front()));
    for (std::size_t i = 1; i < events.t.size(); ++i) {
      ASSERT_NEAR(ToSeconds(events.t[i] - events.t[i - 1]), 0.5, 1e-4) << "a leak is regular";
    }
  }
  std::ranges::sort(first);
  EXPECT_LT(first.front(), 0.02) << "pixels do not leak in step";
  EXPECT_NEAR(first[200], 0.25, 0.06);
  EXPECT_GT(first.back(), 0.48);
}

struct Counts {
  double mean = 0.0;
  double variance = 0.0;
  double positive = 0.0;
};

Counts ShotNoise(double rate_hz, float radiance, double refractory_s) {
  SensorOptions options = IdealSensor(0.3, 0.2);
  options.shot_noise_hz = rate_hz;
  options.refractory_s = refractory_s;
  constexpr int kSize = 50;
  Show show(kSize, kSize, options, 11);
  show.Run(0, 5'000 * kMs, 25 * kMs, [&](int, int, double) { return radiance; });
  Counts counts;
  double squares = 0.0;
  for (const auto& [pixel, events] : ByPixel(show.events)) {
    const auto count = static_cast<double>(events.t.size());
    counts.mean += count / (kSize * kSize);
    squares += count * count / (kSize * kSize);
  }
  counts.variance = squares - counts.mean * counts.mean;
  counts.positive = static_cast<double>(CountOf(show.events, 1)) / static_cast<double>(show.events.size());
  return counts;
}

TEST(SensorNoise, ShotNoiseIsPoissonAndFallsWithLight) {
  for (const auto& [radiance, share] :
       {std::pair(0.0F, 1.0), std::pair(0.5F, 0.625), std::pair(1.0F, 0.25), std::pair(3.0F, 0.25)}) {
    const double expected = 4.0 * share * 5.0;
    const Counts counts = ShotNoise(4.0, radiance, 0.0);
    // Three standard errors over 2500 pixels.
    EXPECT_NEAR(counts.mean, expected, 3.0 * std::sqrt(expected) / 50.0) << radiance;
    EXPECT_NEAR(counts.variance, expected, 3.0 * expected * std::sqrt(2.0) / 50.0 + 0.1) << radiance;
    EXPECT_NEAR(counts.positive, 0.5, 3.0 * 0.5 / std::sqrt(2500.0 * expected)) << radiance;
  }
  // None within the refractory period: the mean interval is 1 / rate + refractory_s.
  EXPECT_NEAR(ShotNoise(4.0, 0.0F, 0.05).mean, 5.0 / 0.3, 0.2);
}

TEST(SensorNoise, NoiseRateOfAStepFollowsItsMeanLight) {
  SensorOptions options = IdealSensor(9.0, 9.0);
  options.shot_noise_hz = 4.0;
  Show show(50, 50, options, 11);
  show.Run(0, 5'000 * kMs, 5'000 * kMs, [](int, int, double t) { return static_cast<float>(t / 5.0); });
  const double expected = 2500.0 * 5.0 * 4.0 * 0.625;
  EXPECT_NEAR(static_cast<double>(show.events.size()), expected, 3.0 * std::sqrt(expected));
}

TEST(SensorNoise, ShotNoiseIsIndependentOfOtherEvents) {
  SensorOptions options = IdealSensor(0.3, 0.2);
  options.leak_hz = 20.0;
  options.shot_noise_hz = 4.0;
  Show show(50, 50, options, 11);
  show.Run(0, 5'000 * kMs, 25 * kMs, [](int, int, double) { return 0.0F; });
  const double expected = 2500.0 * 5.0 * 4.0 / 2.0;
  EXPECT_NEAR(CountOf(show.events, -1), expected, 3.0 * std::sqrt(expected));
  // Each pixel has its own: both of two neighbours fire within 1 ms as often as chance has it.
  const auto pixels = ByPixel(show.events);
  int close = 0;
  for (int y = 0; y < 50; ++y) {
    for (int x = 0; x < 49; ++x) {
      const TimeNs gap = pixels.at({x, y}).t.front() - pixels.at({x + 1, y}).t.front();
      close += std::abs(gap) < kMs ? 1 : 0;
    }
  }
  EXPECT_LT(close, 50 * 49 / 10);
}

TEST(SensorNoise, HotAndDeadPixelsHaveTheirRatios) {
  SensorOptions options = IdealSensor(0.3, 0.2);
  options.hot_pixels = 0.01;
  options.hot_rate_hz = 50.0;
  options.dead_pixels = 0.02;
  constexpr int kSize = 100;
  Show show(kSize, kSize, options);
  show.Run(0, 4'000 * kMs, 4 * kMs, [](int, int, double) { return 0.5F; });
  EXPECT_NEAR(static_cast<double>(ByPixel(show.events).size()), 100.0, 30.0) << "hot";
  EXPECT_NEAR(static_cast<double>(show.events.size()) / (100.0 * 4.0), 50.0, 15.0);
  EXPECT_EQ(CountOf(show.events, -1), 0);
  const events::EventColumns before = show.events;
  show.events.clear();
  show.At(4'004 * kMs, [](int, int, double) { return 0.5F; });
  show.At(4'010 * kMs, [](int, int, double) { return 5.0F; });
  EXPECT_NEAR(kSize * kSize - static_cast<double>(ByPixel(show.events).size()), 200.0, 42.0) << "dead";
}

/// Hot pixels alone, for 20 s.
SensorOptions HotPixels(double noisy, double intermittent) {
  SensorOptions options = IdealSensor(0.3, 0.2);
  options.hot_pixels = 0.1;
  options.hot_rate_hz = 50.0;
  options.hot_noisy = noisy;
  options.hot_intermittent = intermittent;
  return options;
}

TEST(SensorNoise, NoisyHotPixelsFireAtRandomWithBothPolarities) {
  Show steady(40, 40, HotPixels(0.0, 0.0), 3), noisy(40, 40, HotPixels(1.0, 0.0), 3);
  for (Show* show : {&steady, &noisy}) show->Run(0, 20'000 * kMs, 4 * kMs, [](int, int, double) { return 0.5F; });
  EXPECT_EQ(CountOf(steady.events, -1), 0);
  EXPECT_NEAR(static_cast<double>(CountOf(noisy.events, 1)) / static_cast<double>(noisy.events.size()), 0.5, 0.01);
  const auto pixels = ByPixel(noisy.events);
  for (const auto& [pixel, events] : ByPixel(steady.events)) {
    const auto expected = static_cast<double>(events.t.size());
    if (expected < 50.0) continue;
    ASSERT_TRUE(pixels.contains(pixel)) << "the same pixels are hot";
    EXPECT_NEAR(static_cast<double>(pixels.at(pixel).t.size()), expected, 5.0 * std::sqrt(expected));
  }
}

TEST(SensorNoise, IntermittentHotPixelsComeAndGo) {
  Show always(40, 40, HotPixels(0.5, 0.0), 3), sometimes(40, 40, HotPixels(0.5, 1.0), 3);
  for (Show* show : {&always, &sometimes}) show->Run(0, 20'000 * kMs, 4 * kMs, [](int, int, double) { return 0.5F; });
  const double ratio = static_cast<double>(sometimes.events.size()) / static_cast<double>(always.events.size());
  EXPECT_NEAR(ratio, 0.5, 0.1) << "half of the time";
  int with_gaps = 0;
  int busy = 0;
  for (const auto& [pixel, events] : ByPixel(sometimes.events)) {
    if (events.t.size() < 400) continue;
    ++busy;
    TimeNs longest = 0;
    for (std::size_t i = 1; i < events.t.size(); ++i) longest = std::max(longest, events.t[i] - events.t[i - 1]);
    with_gaps += longest > 500 * kMs ? 1 : 0;
  }
  EXPECT_GT(busy, 30);
  EXPECT_GT(with_gaps, busy * 8 / 10);
}

TEST(SensorNoise, HotPixelsDoNotDependOnTheTiles) {
  const auto grey = [](int, int, double) { return 0.5F; };
  Show whole(40, 24, HotPixels(0.5, 0.5), 3), tiles(40, 24, HotPixels(0.5, 0.5), 3, 7);
  for (Show* show : {&whole, &tiles}) show->Run(0, 5'000 * kMs, 4 * kMs, grey);
  const auto expected = ByPixel(whole.events), found = ByPixel(tiles.events);
  ASSERT_EQ(expected.size(), found.size());
  for (const auto& [pixel, events] : expected) EXPECT_EQ(found.at(pixel).t, events.t);
}

// A random texture, reflectance log-normal and with detail at all scales, drifts over the pixels.
class Texture {
 public:
  explicit Texture(double contrast) : contrast_(contrast) {}
  float operator()(int x, int y, double t) const {
    double sum = 0.0;
    for (int cell = 2; cell <= 64; cell *= 2) sum += Noise((x + 60.0 * t + 1000.0) / cell, y / cell, cell);
    return static_cast<float>(0.4 * std::exp(contrast_ * sum));
  }

 private:
  static double Noise(double u, int v, int cell) {
    const double whole = std::floor(u);
    const auto value = [&](double column) {
      return Random(static_cast<std::uint64_t>(cell), static_cast<std::uint64_t>(column) * 4096 + v).Normal();
    };
    return value(whole) + (u - whole) * (value(whole + 1.0) - value(whole));
  }

  double contrast_;
};

TEST(SensorNoise, DefaultSensorHasThePolaritiesAndRatesOfMvsecDriving) {
  const Texture texture(0.2);
  Show show(48, 32, SensorOptions{}, 2, 16);
  show.Run(0, 500 * kMs, 4 * kMs, texture);  // to forget how it began
  show.events.clear();
  show.Run(504 * kMs, 4'000 * kMs, 4 * kMs, texture);
  EXPECT_NEAR(static_cast<double>(CountOf(show.events, -1)) / CountOf(show.events, 1), 3.2, 0.3);
  const double per_frame = static_cast<double>(show.events.size()) / 3.5 * (346.0 * 260.0) / (48.0 * 32.0);
  EXPECT_GT(per_frame, 0.3e6);
  EXPECT_LT(per_frame, 2.0e6) << "events/s, were all of the image so textured";
}

}  // namespace
}  // namespace evo::simulation
