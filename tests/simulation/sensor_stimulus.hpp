#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "simulation/sensor/event_sensor.hpp"

namespace evo::simulation::test {

/// No noise, threshold mismatch, refractory period or low-pass: events where L crosses the thresholds.
inline SensorOptions IdealSensor(double on, double off) {
  SensorOptions options;
  options.threshold_on = on;
  options.threshold_off = off;
  options.threshold_spread = 0.0;
  options.bandwidth_hz = 0.0;
  options.refractory_s = 0.0;
  options.leak_hz = 0.0;
  options.shot_noise_hz = 0.0;
  options.hot_pixels = 0.0;
  options.dead_pixels = 0.0;
  return options;
}

/// The radiance that makes the pixel's log intensity `log`.
inline float RadianceOfLog(double log, const SensorOptions& options) {
  return static_cast<float>(std::exp(log) - options.dark_radiance);
}

using Pixel = std::pair<int, int>;
/// Radiance of pixel (x, y) at a time in s.
using Stimulus = std::function<float(int x, int y, double t)>;

/// Shows a stimulus to a sensor, tile by tile.
class Show {
 public:
  Show(int width, int height, const SensorOptions& options, std::uint64_t seed, int tile)
      : sensor(width, height, options, seed) {
    for (int y = 0; y < height; y += tile) {
      for (int x = 0; x < width; x += tile) {
        tiles.push_back({x, y, std::min(tile, width - x), std::min(tile, height - y)});
      }
    }
  }
  Show(int width, int height, const SensorOptions& options, std::uint64_t seed = 1)
      : Show(width, height, options, seed, std::max(width, height)) {}

  void At(TimeNs t, const Stimulus& stimulus) {
    for (const Tile& tile : tiles) {
      std::vector<float> radiance;
      for (int y = tile.y0; y < tile.y0 + tile.height; ++y) {
        for (int x = tile.x0; x < tile.x0 + tile.width; ++x) radiance.push_back(stimulus(x, y, ToSeconds(t)));
      }
      sensor.Advance(tile, t, radiance, &events);
    }
  }
  /// From time `from` to `to`, both included, every `step`.
  const events::EventColumns& Run(TimeNs from, TimeNs to, TimeNs step, const Stimulus& stimulus) {
    for (TimeNs t = from; t <= to; t += step) At(t, stimulus);
    return events;
  }

  EventSensor sensor;
  std::vector<Tile> tiles;
  events::EventColumns events;
};

struct PixelEvents {
  std::vector<TimeNs> t;
  std::vector<int> polarity;
};

inline std::map<Pixel, PixelEvents> ByPixel(const events::EventColumns& events) {
  std::map<Pixel, PixelEvents> pixels;
  for (std::size_t i = 0; i < events.size(); ++i) {
    PixelEvents& pixel = pixels[{events.x[i], events.y[i]}];
    pixel.t.push_back(events.t[i]);
    pixel.polarity.push_back(events.polarity[i]);
  }
  return pixels;
}

inline int CountOf(const events::EventColumns& events, int polarity) {
  return static_cast<int>(std::count(events.polarity.begin(), events.polarity.end(), polarity));
}

}  // namespace evo::simulation::test
