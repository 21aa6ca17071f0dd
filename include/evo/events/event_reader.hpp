#pragma once

#include <optional>

#include "evo/core/time.hpp"
#include "evo/events/event_columns.hpp"

namespace evo::events {

/// A stretch of a recording in nanoseconds after its first event, as in the paper's "12 s to 72 s".
struct Interval {
  TimeNs from = 0;
  std::optional<TimeNs> to;  ///< up to the end if empty; the event at `to` itself is left out
};

/// A stream of events in blocks: memory stays bounded however long the recording is.
class EventReader {
 public:
  virtual ~EventReader() = default;

  /// Replaces `block` by the next events, at most a few hundred thousand; false when there are no more. Handing the
  /// same block in again saves allocations. Throws Error (kInput) on NaN, time that runs backwards, a pixel off the
  /// sensor, a bad polarity or a truncated file. Only what lies in the interval is read, so only that is checked.
  virtual bool Next(EventColumns* block) = 0;

  /// Stamp of the first event of the whole recording (not of the interval).
  virtual TimeNs first_stamp() const = 0;
  /// Stamp of the last event of the whole recording, which is looked up. Throws Error (kInput) if it cannot be read.
  virtual TimeNs last_stamp() const = 0;
  /// Share of the interval delivered so far, in [0, 1], for the progress bar.
  virtual double progress() const = 0;
};

}  // namespace evo::events
