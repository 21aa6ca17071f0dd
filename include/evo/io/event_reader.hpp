#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "evo/core/time.hpp"
#include "evo/events/event_columns.hpp"

namespace evo {

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

/// Opens an MVSEC .hdf5 (left DAVIS), a UZH events.txt or a folder that holds either; the kind is told by content.
/// `width` x `height` px is the sensor that the calibration promises.
///
/// MVSEC: `davis/left/events`, N x 4 of x y t p in any numeric type and any layout; t in seconds. An integer type
/// cannot hold seconds: its stamps are taken as epoch micro- or nanoseconds where their size tells which, and refused
/// otherwise. A block is a whole number of chunks, so nothing is inflated twice; a single huge chunk is held in memory.
/// UZH: lines `t x y p`, t in seconds, exact to the nanosecond.
/// Both: p is 1, and 0 or -1 for darker. The interval's ends are found by bisection, without reading what lies before.
///
/// Throws Error: kInput for a missing, unreadable or foreign file, kNothingToDo if no event lies in the interval.
std::unique_ptr<EventReader> OpenEvents(const std::filesystem::path& path, const Interval& interval, int width,
                                        int height);

}  // namespace evo
