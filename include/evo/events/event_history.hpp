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

/// Events around a moving point, relative to this centre and to a reference instant. Entry i of each column belongs to
/// event i.
struct LocalEvents {
  std::vector<float> x;   ///< px, raw column minus the centre's
  std::vector<float> y;   ///< px, raw row minus the centre's
  std::vector<float> dt;  ///< s after the reference instant
  std::vector<std::int8_t> polarity;

  std::size_t size() const { return x.size(); }
  void resize(std::size_t count);
  void push_back(float event_x, float event_y, float event_dt, std::int8_t event_polarity) {
    x.push_back(event_x);
    y.push_back(event_y);
    dt.push_back(event_dt);
    polarity.push_back(event_polarity);
  }
  /// Keeps an even sample of at most `max_count` events.
  void Subsample(std::size_t max_count);
};

/// A square patch that moves with constant velocity during [t - half_window, t + half_window].
struct MovingPatch {
  TimeNs t = 0;               ///< reference instant
  double x = 0.0, y = 0.0;    ///< px, centre at `t`
  double vx = 0.0, vy = 0.0;  ///< px/s
  double radius = 0.0;        ///< px, half side
  TimeNs half_window = 0;     ///< at most EventHistory::kMaxHalfWindow
};

/// The most recent events, indexed by time and place: short slices of time, each sorted by square tiles of the sensor.
/// The events of a patch are found without a look at the others, and those of a row of tiles are contiguous.
class EventHistory {
 public:
  EventHistory(int width, int height);

  static constexpr TimeNs kMaxHalfWindow = 1'000'000'000;  ///< stamps relative to a window's middle fit into 32 bits

  /// Adds events [begin, end) of `events`. Their stamps must not precede those of earlier calls.
  void Append(const EventColumns& events, std::size_t begin, std::size_t end);
  void Append(const EventColumns& events) { Append(events, 0, events.size()); }
  /// Forgets the events before `t`.
  void DropBefore(TimeNs t);

  /// Replaces `local` by the events of `patch`, ordered by slice, tile and time. Throws std::length_error if the
  /// window is longer than allowed.
  void Gather(const MovingPatch& patch, LocalEvents* local) const;

  /// Begin of the shortest window up to `end` (exclusive) that holds `count` events, but not before `begin`; the stamp
  /// of the oldest event if there are fewer, and `end` if there are none.
  TimeNs NewestWindowBegin(TimeNs begin, TimeNs end, std::size_t count) const;

  /// Calls visit(x, y, t, polarity) for every event of [begin, end), ordered by slice, tile and time.
  template <typename Visitor>
  void ForEachBetween(TimeNs begin, TimeNs end, Visitor visit) const {
    ForEachInTiles(0, columns_ * rows_, begin, end, visit);
  }
  /// Calls `visit` for the events of one tile, ordered by time. Tiles are numbered row by row.
  template <typename Visitor>
  void ForEachInTile(std::size_t tile, TimeNs begin, TimeNs end, Visitor visit) const {
    ForEachInTiles(tile, tile + 1, begin, end, visit);
  }

  static constexpr int kTilePx = 8;  ///< side of a tile, px: half a patch, so that a patch reads few foreign events
  std::size_t tile_columns() const { return columns_; }
  std::size_t tile_rows() const { return rows_; }

  int width() const { return width_; }    ///< px
  int height() const { return height_; }  ///< px

 private:
  /// Eight bytes: memory traffic dominates the cost of a look-up.
  struct Entry {
    std::uint32_t t_and_sign;  // 2 x (ns since the slice's begin) + (1 if the polarity is positive)
    std::uint16_t x, y;        // px

    std::int32_t t() const { return static_cast<std::int32_t>(t_and_sign >> 1); }
    std::int8_t polarity() const { return static_cast<std::int8_t>(2 * static_cast<int>(t_and_sign & 1) - 1); }
  };
  struct Slice {
    TimeNs begin = 0;
    std::vector<Entry> entries;         // ordered by tile and time
    std::vector<std::uint32_t> starts;  // index of each tile's first entry, and the number of entries

    /// The entries of tiles [first, end).
    std::span<const Entry> TileEntries(std::size_t first, std::size_t end) const {
      return {entries.data() + starts[first], entries.data() + starts[end]};
    }
  };
  /// Contiguous entries of a slice, which may belong to a patch.
  struct Run {
    std::span<const Entry> entries;
    std::int32_t offset;       // ns from the patch's reference instant to the slice's begin
    std::int32_t first, last;  // ns since the slice's begin, of the window
  };
  static constexpr TimeNs kSlice = 10'000'000;  // ns; the tracker's windows last 4 to 80 ms

  std::size_t TileIndex(unsigned x, unsigned y) const { return y / kTilePx * columns_ + x / kTilePx; }
  /// Adds events [begin, end), all of which lie in it, to the slice that begins at `t`: the newest one or a new one.
  void AddToSlice(TimeNs t, const EventColumns& events, std::size_t begin, std::size_t end);
  /// Appends a slice that begins at `t`, in the memory of a forgotten one if there is any.
  void StartSlice(TimeNs t);
  /// Makes room in the newest slice for events [begin, end): afterwards `next_` holds the place of each tile's next
  /// one.
  void MakeRoom(const EventColumns& events, std::size_t begin, std::size_t end);
  /// Index of the first slice that ends after `t`.
  std::size_t FirstSliceEndingAfter(TimeNs t) const;
  /// Appends the runs of one slice that the patch may touch during the window [begin, last].
  void FindRuns(const MovingPatch& patch, const Slice& slice, TimeNs begin, TimeNs last, std::vector<Run>* runs) const;

  template <typename Visitor>
  void ForEachInTiles(std::size_t first, std::size_t end_tile, TimeNs begin, TimeNs end, Visitor visit) const {
    begin = std::max(begin, oldest_);
    for (std::size_t i = FirstSliceEndingAfter(begin); i < slices_.size() && slices_[i].begin < end; ++i) {
      const TimeNs slice_begin = slices_[i].begin;
      const bool is_whole = begin <= slice_begin && slice_begin + kSlice <= end;
      for (const Entry& entry : slices_[i].TileEntries(first, end_tile)) {
        const TimeNs t = slice_begin + entry.t();
        if (is_whole || (t >= begin && t < end)) visit(entry.x, entry.y, t, entry.polarity());
      }
    }
  }

  int width_;
  int height_;
  std::size_t columns_;                                 // of tiles
  std::size_t rows_;                                    // of tiles
  std::deque<Slice> slices_;                            // ordered by time; only slices with events
  std::optional<TimeNs> origin_;                        // begin of the first slice
  TimeNs oldest_ = std::numeric_limits<TimeNs>::min();  // events before this are forgotten
  // Buffers that are kept for their memory.
  std::vector<Slice> spare_;
  std::vector<Entry> merged_;
  std::vector<std::uint32_t> next_;
};

}  // namespace evo::events
