#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

#include "events/flicker/flicker_comb.hpp"
#include "events/flicker/flicker_detector.hpp"
#include "events/flicker/tiles.hpp"
#include "evo/core/time.hpp"
#include "evo/events/event_columns.hpp"
#include "evo/events/flicker.hpp"

namespace evo::events {

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

  /// Takes the next events of the stream and replaces them by those that are ready, in order of time; maybe none.
  void Apply(EventColumns* block);
  /// Replaces `block` by the events that are still held, at the end of the stream.
  void Finish(EventColumns* block);

  FlickerStatistics statistics() const;

 private:
  /// Appends what is ready of the events until the end of `events` to `out`.
  void Filter(EventColumns&& events, EventColumns* out);
  /// Whether anything flickers until `t`, or events of the comb are left.
  bool AnyFlickers(TimeNs t) const;
  void EnterSegmentOf(TimeNs t);
  void CountEvents();
  void AddDuration(TimeNs end);
  /// Appends the events before `end` to `out`, in order of time.
  void Merge(TimeNs end, EventColumns* out);

  FlickerTiles tiles_;
  bool remove_;
  FlickerDetector detector_;
  FlickerComb comb_;
  std::deque<FlickerSegment> segments_;  // the present one first
  std::deque<EventColumns> waiting_;     // blocks whose segments are not known yet
  EventColumns passed_;                  // ordered by time
  EventColumns replaced_;                // by the comb
  bool has_segment_ = false;
  TimeNs last_ = 0;  // stamp of the last event
  TimeNs segment_begin_ = 0;
  TimeNs segment_end_ = 0;
  std::size_t flickering_tiles_ = 0;
  double frequency_hz_ = 0.0;
  std::uint64_t in_segment_ = 0;
  FlickerStatistics statistics_;
  double frequency_sum_ = 0.0;
  double tile_seconds_ = 0.0;
  double duration_s_ = 0.0;
};

}  // namespace evo::events
