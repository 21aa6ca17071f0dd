#pragma once

#include <optional>

#include "evo/core/time.hpp"
#include "evo/events/event_columns.hpp"

namespace evo::events {

/// An interval of a recording, in ns since its first event.
struct Interval {
  TimeNs from = 0;
  std::optional<TimeNs> to;  ///< exclusive; empty: the end of the recording
};

/// A stream of events in blocks. Memory does not grow with the length of the recording.
class EventReader {
 public:
  virtual ~EventReader() = default;

  /// Replaces `block` by the next events, at most a few hundred thousand, and returns false if there are none. A reused
  /// block saves allocations. Throws Error (kInput) for NaN, a stamp before its predecessor, a pixel outside the
  /// sensor, an invalid polarity or a truncated file. Events outside the interval are neither read nor checked.
  virtual bool Next(EventColumns* block) = 0;

  /// Stamp of the first event of the whole recording (not of the interval).
  virtual TimeNs first_stamp() const = 0;
  /// Stamp of the last event of the whole recording, read on demand. Throws Error (kInput) if it is unreadable.
  virtual TimeNs last_stamp() const = 0;
  /// Ratio of the interval delivered so far, in [0, 1].
  virtual double progress() const = 0;
};

}  // namespace evo::events
