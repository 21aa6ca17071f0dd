#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "evo/core/parameters.hpp"
#include "evo/core/time.hpp"
#include "evo/events/event_columns.hpp"
#include "evo/simulation/renderer.hpp"

namespace evo {

/// An event pixel array after P. Lichtsteiner et al. (JSSC 2008) with the noise of Y. Hu et al. (v2e, CVPRW 2021):
/// photoreceptor (log, low-pass), change detector with thresholds, leak and shot noise, refractory period, readout.
struct SensorOptions {
  double threshold_on = 0.25;       ///< change of log intensity that makes a positive event
  double threshold_off = 0.20;      ///< and a negative one; lower: more negative events
  double threshold_spread = 0.03;   ///< standard deviation of both over the pixels
  double bandwidth_hz = 300.0;      ///< cut-off of the photoreceptor at radiance 1; 0: none
  double dark_bandwidth_hz = 10.0;  ///< cut-off in the dark: bandwidth grows in proportion to radiance above it
  double refractory_s = 0.0005;     ///< a pixel is blind so long after an event
  double leak_hz = 0.1;             ///< positive events of a pixel that sees no change
  double shot_noise_hz = 0.5;       ///< random events of a dark pixel; a bright one (radiance 1) has a quarter
  double hot_pixels = 0.0002;       ///< share of pixels that fire by themselves
  double hot_rate_hz = 100.0;       ///< mean rate of such a pixel
  double dead_pixels = 0.0002;      ///< share of pixels that never fire
  double dark_radiance = 0.002;     ///< added to all radiance: the dark current
  double readout_row_s = 0.0;       ///< row-readout jitter: stamps of a row are delayed by up to so much
};

void Register(Parameters& parameters, SensorOptions& options);

/// The state of all pixels. Each has its own random stream, so that tiles can be advanced in any order and in parallel
/// (one thread a tile) with the same result.
class EventSensor {
 public:
  EventSensor(int width, int height, const SensorOptions& options, std::uint64_t seed);

  /// Tells the pixels of `tile` the radiance that they see at `t` (row by row); between two calls for one tile it is
  /// taken to change linearly in its logarithm. Appends the events since the last call to `events`, each pixel's in
  /// order of time, stamps in whole microseconds. The first call only sets the state.
  void Advance(const Tile& tile, TimeNs t, std::span<const float> radiance, EventColumns* events);
};

}  // namespace evo
