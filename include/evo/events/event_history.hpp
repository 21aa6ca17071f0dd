#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/events/event_columns.hpp"

namespace evo {

/// The events around a moving point, relative to that point and to a reference instant: column i belongs to event i.
struct LocalEvents {
  std::vector<float> x;   ///< px, raw column minus the centre's
  std::vector<float> y;   ///< px, raw row minus the centre's
  std::vector<float> dt;  ///< s after the reference instant
  std::vector<std::int8_t> polarity;

  std::size_t size() const { return x.size(); }
  void clear();
  /// Keeps an even sample of at most `count` events.
  void Thin(std::size_t count);
};

/// Which events to gather: those within `radius` px (in x and in y) of a centre that passes (x, y) at `t` with a
/// velocity, during [t - half_window, t + half_window].
struct MovingPatch {
  TimeNs t = 0;
  double x = 0.0, y = 0.0;    ///< px
  double vx = 0.0, vy = 0.0;  ///< px/s
  double radius = 0.0;        ///< px
  TimeNs half_window = 0;
};

/// The most recent events, binned by short slices of time and small tiles of the sensor, so that the events around a
/// feature are found without looking at the others.
class EventHistory {
 public:
  EventHistory(int width, int height, TimeNs slice_duration);

  /// `events` follow the ones appended before in time.
  void Append(const EventColumns& events);
  /// Makes the last, unfinished slice visible too. Append() may follow only with events of later slices.
  void Finish();
  /// Forgets slices that end before `t`.
  void DropBefore(TimeNs t);

  /// Replaces `local` by the events of `patch`, slice by slice and tile by tile (the order is fixed, not by time).
  void Gather(const MovingPatch& patch, LocalEvents* local) const;

  /// The latest stamp from which on there are `count` events before `end`, or the oldest slice's begin if there are not
  /// so many.
  TimeNs BeginOfNewest(TimeNs end, std::size_t count) const;

  /// Calls visit(x, y, t, polarity) for every event of [begin, end).
  template <typename Visitor>
  void ForEachBetween(TimeNs begin, TimeNs end, Visitor visit) const {
    for (const Slice& slice : slices_) {
      if (slice.begin >= end || slice.begin + slice_duration_ <= begin) continue;
      for (const Entry& entry : slice.entries) {
        const TimeNs t = slice.begin + entry.offset_ns;
        if (t >= begin && t < end) visit(entry.x, entry.y, t, entry.polarity);
      }
    }
  }

  int width() const { return width_; }
  int height() const { return height_; }

 private:
  struct Entry {
    std::int32_t offset_ns;  // after the slice's begin
    std::uint16_t x;
    std::uint16_t y;
    std::int8_t polarity;
  };
  struct Slice {
    TimeNs begin = 0;
    std::vector<std::uint32_t> tile_begin;  // row-major, one past the end at the back
    std::vector<Entry> entries;             // by tile, then time
  };

  std::size_t TileOf(const Entry& entry) const;

  int width_;
  int height_;
  TimeNs slice_duration_;
  std::size_t tile_columns_;
  std::size_t tile_rows_;
  std::deque<Slice> slices_;
  std::vector<Slice> spare_;    // dropped slices, kept for their memory
  std::vector<Entry> pending_;  // the slice being filled, in order of time
  TimeNs pending_begin_ = 0;
};

}  // namespace evo
