#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/events/event_columns.hpp"

namespace evo::events {

/// The events around a moving point, relative to that point and to a reference instant: column i belongs to event i.
struct LocalEvents {
  std::vector<float> x;   ///< px, raw column minus the centre's
  std::vector<float> y;   ///< px, raw row minus the centre's
  std::vector<float> dt;  ///< s after the reference instant
  std::vector<std::int8_t> polarity;

  std::size_t size() const { return x.size(); }
  void resize(std::size_t count);
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
  TimeNs half_window = 0;     ///< at most EventHistory::kLongestHalfWindow
};

/// The most recent events, cut into short slices of time, and each of these sorted by small tiles of the sensor: the
/// events around a feature are found without looking at the others, and those of a row of tiles lie side by side.
class EventHistory {
 public:
  EventHistory(int width, int height);

  static constexpr TimeNs kLongestHalfWindow = 1'000'000'000;

  /// Events [begin, end) of `events`, which follow the ones appended before in time.
  void Append(const EventColumns& events, std::size_t begin, std::size_t end);
  void Append(const EventColumns& events) { Append(events, 0, events.size()); }
  /// Forgets the events before `t`.
  void DropBefore(TimeNs t);

  /// Replaces `local` by the events of `patch`, slice by slice, in each tile by tile, in each by time. Throws
  /// std::length_error for too long a window.
  void Gather(const MovingPatch& patch, LocalEvents* local) const;

  /// The latest stamp from which on there are `count` events before `end`, or the oldest event's if there are not so
  /// many.
  TimeNs BeginOfNewest(TimeNs begin, TimeNs end, std::size_t count) const;

  /// Calls visit(x, y, t, polarity) for every event of [begin, end), slice by slice, in each tile by tile, in each by
  /// time.
  template <typename Visitor>
  void ForEachBetween(TimeNs begin, TimeNs end, Visitor visit) const {
    ForEachInTiles(0, columns_ * rows_, begin, end, visit);
  }
  /// The same for one tile, by time. Tiles are counted row by row.
  template <typename Visitor>
  void ForEachInTile(std::size_t tile, TimeNs begin, TimeNs end, Visitor visit) const {
    ForEachInTiles(tile, tile + 1, begin, end, visit);
  }

  static constexpr int kTilePx = 8;  ///< side of a tile
  std::size_t tile_columns() const { return columns_; }
  std::size_t tile_rows() const { return rows_; }

  int width() const { return width_; }
  int height() const { return height_; }

 private:
  /// As small as can be: the memory that the events fill is what finding them costs.
  struct Entry {
    std::uint32_t t_and_sign;  // twice the ns since the slice's begin, and one for a positive polarity
    std::uint16_t x, y;        // px

    std::int32_t t() const { return static_cast<std::int32_t>(t_and_sign >> 1); }
    std::int8_t polarity() const { return static_cast<std::int8_t>(2 * static_cast<int>(t_and_sign & 1) - 1); }
  };
  struct Slice {
    TimeNs begin = 0;
    std::vector<Entry> entries;         // tile by tile, in each by time
    std::vector<std::uint32_t> starts;  // of each tile in the entries, and the end

    /// The entries of tiles [first, end).
    std::span<const Entry> Of(std::size_t first, std::size_t end) const {
      return {entries.data() + starts[first], entries.data() + starts[end]};
    }
  };
  static constexpr TimeNs kSlice = 10'000'000;

  std::size_t TileOf(unsigned x, unsigned y) const { return y / kTilePx * columns_ + x / kTilePx; }
  /// Adds events [begin, end), which lie in it, to the slice from `t` on: the newest one or a new one.
  void AddToSlice(TimeNs t, const EventColumns& events, std::size_t begin, std::size_t end);
  /// The index of the first slice that ends after `t`.
  std::size_t SliceAfter(TimeNs t) const;

  template <typename Visitor>
  void ForEachInTiles(std::size_t first, std::size_t end_tile, TimeNs begin, TimeNs end, Visitor visit) const {
    begin = std::max(begin, oldest_);
    for (std::size_t i = SliceAfter(begin); i < slices_.size() && slices_[i].begin < end; ++i) {
      const TimeNs slice_begin = slices_[i].begin;
      const bool is_whole = begin <= slice_begin && slice_begin + kSlice <= end;
      for (const Entry& entry : slices_[i].Of(first, end_tile)) {
        const TimeNs t = slice_begin + entry.t();
        if (is_whole || (t >= begin && t < end)) visit(entry.x, entry.y, t, entry.polarity());
      }
    }
  }

  int width_;
  int height_;
  std::size_t columns_;  // of tiles
  std::size_t rows_;
  std::deque<Slice> slices_;                            // by time, those that hold events
  std::vector<Slice> spare_;                            // kept for their memory, like the following two
  std::vector<Entry> merged_;                           // while a slice is sorted
  std::vector<std::uint32_t> next_;                     // where the next event of each tile goes
  std::optional<TimeNs> origin_;                        // where the first slice began
  TimeNs oldest_ = std::numeric_limits<TimeNs>::min();  // events before this are forgotten
};

}  // namespace evo::events
