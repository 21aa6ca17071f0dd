#pragma once

#include <cstdint>
#include <memory>

#include "evo/core/time.hpp"
#include "evo/events/event_columns.hpp"

namespace evo {
class Parameters;
}

namespace evo::events {

/// Names events.flicker.*.
struct FlickerOptions {
  bool remove = true;
  double min_frequency_hz = 80.0;
  double max_frequency_hz = 400.0;
};
void Register(Parameters& parameters, FlickerOptions& options);

/// What a FlickerFilter has seen so far.
struct FlickerStatistics {
  double frequency_hz = 0.0;         ///< of most flickering events; 0: no flicker
  std::uint64_t events = 0;          ///< read
  std::uint64_t flicker_events = 0;  ///< read in flickering tiles
  std::uint64_t replaced_by = 0;     ///< given in their place
  double tile_ratio = 0.0;           ///< flickering tiles over all tiles, mean over time
};

/// Removes the events of lamps that flicker (twice the frequency of the mains, or a dimmer's) from a stream.
///
/// A tile of the sensor flickers if its events, negative ones counted negatively, have a line in their spectrum that
/// both halves of its pixels show, a chessboard's black and white fields, at a frequency that other tiles or earlier
/// times confirm. There, log intensity is the scene's plus a periodic part, so its mean over one period is the scene's:
/// each pixel's level, the sum of its events, is averaged over one period, and an event is given whenever the mean has
/// moved by a threshold. Flicker vanishes, a moving edge stays, its events spread over one period about their true
/// time. Events elsewhere pass unchanged.
///
/// Events are held back for 0.2 s of the stream, so that flicker is known when it begins. Memory is bounded by that and
/// by the sensor's size.
class FlickerFilter {
 public:
  FlickerFilter(int width, int height, const FlickerOptions& options);
  ~FlickerFilter();

  /// Takes the next events of the stream and replaces them by those that are ready, in order of time; maybe none.
  void Apply(EventColumns* block);
  /// Replaces `block` by the events that are still held, at the end of the stream.
  void Finish(EventColumns* block);

  FlickerStatistics statistics() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace evo::events
