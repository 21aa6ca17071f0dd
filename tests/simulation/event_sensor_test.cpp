#include "simulation/sensor/event_sensor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "evo/core/random.hpp"
#include "simulation/sensor_stimulus.hpp"

// Noise-free events against closed forms.

namespace evo::simulation {
namespace {

using test::ByPixel;
using test::CountOf;
using test::IdealSensor;
using test::RadianceOfLog;
using test::Show;

constexpr TimeNs kMs = 1'000'000;
constexpr TimeNs kUs = 1'000;

TEST(EventSensor, RampCrossesTheThresholdsAtTheClosedFormsTimes) {
  const SensorOptions options = IdealSensor(0.25, 0.16);
  for (const double slope : {1.3, -1.3}) {
    Show show(1, 1, options);
    // Steps of 7 ms: none of the crossings lies on one.
    show.Run(0, 2002 * kMs, 7 * kMs, [&](int, int, double t) { return RadianceOfLog(-1.0 + slope * t, options); });
    const double threshold = slope > 0 ? 0.25 : 0.16;
    ASSERT_EQ(show.events.size(), static_cast<std::size_t>(std::floor(1.3 * 2.002 / threshold)));
    for (std::size_t i = 0; i < show.events.size(); ++i) {
      EXPECT_EQ(show.events.polarity[i], slope > 0 ? 1 : -1);
      EXPECT_NEAR(ToSeconds(show.events.t[i]), static_cast<double>(i + 1) * threshold / 1.3, 2.5e-6);
    }
  }
}

TEST(EventSensor, MovingEdgeFiresAtItsPosition) {
  // An edge of 4 px width and contrast 1.1 goes over the pixels at 1 px/ms.
  const SensorOptions options = IdealSensor(0.2, 0.2);
  Show show(40, 2, options);
  show.Run(0, 50 * kMs, kMs, [&](int x, int y, double t) {
    const double done = std::clamp((1000.0 * t - x) / 4.0, 0.0, 1.0);
    return RadianceOfLog(y == 0 ? -2.0 + 1.1 * done : -0.9 - 1.1 * done, options);
  });
  const auto pixels = ByPixel(show.events);
  ASSERT_EQ(pixels.size(), 80U);
  for (const auto& [pixel, events] : pixels) {
    ASSERT_EQ(events.t.size(), 5U) << "floor(contrast / threshold)";
    for (std::size_t k = 0; k < 5; ++k) {
      const double expected = (pixel.first + 4.0 * static_cast<double>(k + 1) * 0.2 / 1.1) * 1e-3;
      EXPECT_NEAR(ToSeconds(events.t[k]), expected, 1.2e-6);
      EXPECT_EQ(events.polarity[k], pixel.second == 0 ? 1 : -1);
    }
  }
}

// A step of log intensity by `height` at t = 0 (a ramp of 1 us), then constant.
events::EventColumns StepResponse(const SensorOptions& options, double from, double height) {
  Show show(1, 1, options);
  show.At(-kUs, [&](int, int, double) { return RadianceOfLog(from, options); });
  show.Run(0, 400 * kMs, 10 * kMs, [&](int, int, double) { return RadianceOfLog(from + height, options); });
  return show.events;
}

TEST(EventSensor, StepResponseIsThatOfALowPass) {
  SensorOptions options = IdealSensor(0.2, 0.2);
  options.bandwidth_hz = 40.0;
  options.dark_bandwidth_hz = 5.0;
  struct Case {
    double from, height, cut_off_hz;
  };
  // Above radiance 1 the cut-off is the bandwidth, below it falls with radiance, in the dark it stays.
  for (const Case c : {Case{0.5, 1.1, 40.0}, Case{2.0, -1.1, 40.0}, Case{std::log(0.5) - 1.1, 1.1, 20.0 - 0.08},
                       Case{std::log(0.25) + 1.1, -1.1, 10.0 - 0.08}, Case{-5.0, 1.1, 5.0}}) {
    const events::EventColumns events = StepResponse(options, c.from, c.height);
    ASSERT_EQ(events.size(), 5U) << c.from;
    for (std::size_t k = 0; k < 5; ++k) {
      const double share = 0.2 * static_cast<double>(k + 1) / 1.1;
      const double expected = -std::log(1.0 - share) / (2.0 * std::numbers::pi * c.cut_off_hz);
      EXPECT_NEAR(ToSeconds(events.t[k]), expected, 2.5e-6 + 1e-5 * expected) << c.from << " event " << k;
      EXPECT_EQ(events.polarity[k], c.height > 0 ? 1 : -1);
    }
  }
}

TEST(EventSensor, FindsAnExtremumWithinAStep) {
  // y lags behind L that falls: it rises until it meets L, at t* with exp(-w t*) = s / (w C).
  SensorOptions options = IdealSensor(0.3, 5.0);
  options.bandwidth_hz = options.dark_bandwidth_hz = 50.0;
  const double w = 2.0 * std::numbers::pi * 50.0, slope = -50.0, transient = -1.0 - slope / -w;
  const double peak_at = -std::log(slope / (w * transient)) / w;
  const double peak = 1.0 + slope * (peak_at - 1.0 / w) + transient * slope / (w * transient);
  ASSERT_GT(peak, 0.35);
  ASSERT_LT(1.0 + slope * 0.02, 0.01) << "gone at the end of the step";
  const auto events_with = [&](double threshold) {
    options.threshold_on = threshold;
    Show show(1, 1, options);
    show.At(-kUs, [&](int, int, double) { return RadianceOfLog(-1.0, options); });
    show.At(0, [&](int, int, double) { return RadianceOfLog(0.0, options); });
    show.At(20 * kMs, [&](int, int, double) { return RadianceOfLog(-1.0, options); });
    return show.events;
  };
  const events::EventColumns below = events_with(peak - 0.003);
  ASSERT_EQ(below.size(), 1U);
  EXPECT_LT(ToSeconds(below.t[0]), peak_at);
  EXPECT_GT(ToSeconds(below.t[0]), 0.7 * peak_at);
  EXPECT_EQ(events_with(peak + 0.003).size(), 0U);
}

// Piecewise linear in log, knots every 4 ms, different for each pixel.
double Wander(int x, int y, double t) {
  const auto knot = static_cast<int>(std::floor(t / 0.004 + 1e-9));
  const auto value = [&](int k) { return Random(99, static_cast<std::uint64_t>((y * 100 + x) * 1000 + k)).Normal(); };
  const double share = t / 0.004 - knot;
  return -1.0 + (1.0 - share) * value(knot) + share * value(knot + 1);
}

TEST(EventSensor, EventsDoNotDependOnTheSteps) {
  SensorOptions options = IdealSensor(0.3, 0.2);
  options.bandwidth_hz = options.dark_bandwidth_hz = 60.0;
  options.refractory_s = 0.0003;
  options.threshold_spread = 0.02;
  const auto stimulus = [&](int x, int y, double t) { return RadianceOfLog(Wander(x, y, t), options); };
  Show coarse(8, 8, options);
  Show fine(8, 8, options);
  coarse.Run(0, 400 * kMs, 4 * kMs, stimulus);
  fine.Run(0, 400 * kMs, kMs / 2, stimulus);
  const auto expected = ByPixel(coarse.events);
  const auto actual = ByPixel(fine.events);
  ASSERT_GT(coarse.events.size(), 64U * 40U);
  int same = 0;
  for (const auto& [pixel, events] : expected) {
    const auto found = actual.find(pixel);
    ASSERT_NE(found, actual.end());
    if (events.polarity != found->second.polarity) continue;  // a peak that just touches a threshold
    ++same;
    for (std::size_t i = 0; i < events.t.size(); ++i) {
      EXPECT_NEAR(static_cast<double>(events.t[i]), static_cast<double>(found->second.t[i]), 20.0 * kUs);
    }
  }
  EXPECT_GE(same, 60);
}

// |log intensity change at the first event| of each pixel, on a slow ramp.
std::vector<double> MeasureThresholds(const SensorOptions& options, int size, double slope) {
  Show show(size, size, options, 5);
  show.Run(0, 1000 * kMs, 50 * kMs, [&](int, int, double t) { return RadianceOfLog(-1.0 + slope * t, options); });
  std::vector<double> thresholds;
  for (const auto& [pixel, events] : ByPixel(show.events)) {
    thresholds.push_back(std::abs(slope) * ToSeconds(events.t.front()));
  }
  return thresholds;
}

TEST(EventSensor, IntegratedEventsEqualTheLogChange) {
  SensorOptions options = IdealSensor(0.3, 0.2);
  options.threshold_spread = 0.03;
  constexpr int kSize = 24;
  const std::vector<double> on = MeasureThresholds(options, kSize, 1.0);
  const std::vector<double> off = MeasureThresholds(options, kSize, -1.0);
  ASSERT_EQ(on.size(), static_cast<std::size_t>(kSize * kSize));
  ASSERT_EQ(off.size(), on.size());
  Show show(kSize, kSize, options, 5);
  show.Run(0, 200 * kMs, 4 * kMs, [&](int x, int y, double t) { return RadianceOfLog(Wander(x, y, t), options); });
  auto pixels = ByPixel(show.events);
  double mean = 0.0, variance = 0.0;
  for (int x = 0, i = 0; x < kSize; ++x) {
    for (int y = 0; y < kSize; ++y, ++i) {
      double sum = 0.0;
      for (const int sign : pixels[{x, y}].polarity) sum += sign > 0 ? on[i] : -off[i];
      const double rest = Wander(x, y, 0.2) - Wander(x, y, 0.0) - sum;
      const double slack = 1e-5 * static_cast<double>(pixels[{x, y}].t.size()) + 1e-5;
      EXPECT_LT(rest, on[i] + slack);
      EXPECT_GT(rest, -off[i] - slack);
      mean += on[i] / on.size();
      variance += (on[i] - 0.3) * (on[i] - 0.3) / on.size();
    }
  }
  EXPECT_NEAR(mean, 0.3, 0.004) << "thresholds over the pixels";
  EXPECT_NEAR(std::sqrt(variance), 0.03, 0.003);
}

TEST(EventSensor, ResetsAtTheEndOfTheRefractoryPeriod) {
  SensorOptions options = IdealSensor(0.2, 0.2);
  options.refractory_s = 0.013;
  Show show(1, 1, options);
  show.Run(0, 1500 * kMs, 5 * kMs, [&](int, int, double t) { return RadianceOfLog(-2.0 + 2.0 * t, options); });
  ASSERT_EQ(show.events.size(), static_cast<std::size_t>((1.5 + 0.013) / 0.113));
  for (std::size_t i = 0; i < show.events.size(); ++i) {
    EXPECT_NEAR(ToSeconds(show.events.t[i]), 0.1 + static_cast<double>(i) * 0.113, 2.5e-6);
  }
}

TEST(EventSensor, SymmetricStimulusGivesTheThresholdsRatioOfPolarities) {
  const SensorOptions options = IdealSensor(0.3, 0.1);
  Show show(4, 4, options);
  show.Run(0, 5000 * kMs, kMs, [&](int x, int y, double t) {
    return RadianceOfLog(-1.0 + 1.5 * std::sin(2.0 * std::numbers::pi * 2.0 * t + x + 4 * y), options);
  });
  EXPECT_NEAR(static_cast<double>(CountOf(show.events, -1)) / CountOf(show.events, 1), 3.0, 0.05);
}

}  // namespace
}  // namespace evo::simulation
