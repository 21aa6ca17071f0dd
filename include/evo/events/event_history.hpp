#pragma once

#include <cstdint>
#include <limits>
#include <span>
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
  TimeNs half_window = 0;
};

/// The most recent events, each small tile of the sensor for itself in order of time, so that the events around a
/// feature are found without looking at the others and lie side by side in memory.
class EventHistory {
 public:
  EventHistory(int width, int height);

  /// The longest stretch of time that is held at once, ns.
  static constexpr TimeNs kLongest = std::numeric_limits<std::int32_t>::max();

  /// Events [begin, end) of `events`, which follow the ones appended before in time. Throws std::length_error where the
  /// last of them is more than `kLongest` after the first one that is held.
  void Append(const EventColumns& events, std::size_t begin, std::size_t end);
  void Append(const EventColumns& events) { Append(events, 0, events.size()); }
  /// Forgets the events before `t`.
  void DropBefore(TimeNs t);

  /// Replaces `local` by the events of `patch`, tile by tile, in each by time.
  void Gather(const MovingPatch& patch, LocalEvents* local) const;

  /// The latest stamp from which on there are `count` events before `end`, or the oldest event's if there are not so
  /// many.
  TimeNs BeginOfNewest(TimeNs begin, TimeNs end, std::size_t count) const;

  /// Calls visit(x, y, t, polarity) for every event of [begin, end), tile by tile, in each by time.
  template <typename Visitor>
  void ForEachBetween(TimeNs begin, TimeNs end, Visitor visit) const {
    for (std::size_t i = 0; i < tiles_.size(); ++i) ForEachInTile(i, begin, end, visit);
  }
  /// The same for one tile, by time. Tiles are counted row by row.
  template <typename Visitor>
  void ForEachInTile(std::size_t tile, TimeNs begin, TimeNs end, Visitor visit) const {
    const int left = static_cast<int>(tile % columns_) * kTilePx;
    const int top = static_cast<int>(tile / columns_) * kTilePx;
    for (const Entry& entry : Between(tile, begin, end)) {
      visit(left + entry.x, top + entry.y, oldest_ + entry.After(oldest_), entry.polarity);
    }
  }

  static constexpr int kTilePx = 8;  ///< side of a tile
  std::size_t tile_columns() const { return columns_; }
  std::size_t tile_rows() const { return rows_; }

  int width() const { return width_; }
  int height() const { return height_; }

 private:
  /// As small as can be: the memory that the events fill is what finding them costs.
  struct Entry {
    std::uint32_t t;    // the stamp's lower half
    std::uint8_t x, y;  // within the tile
    std::int8_t polarity;

    /// ns, negative before it; of an instant no farther off than `kLongest`.
    std::int32_t After(TimeNs instant) const {
      return static_cast<std::int32_t>(t - static_cast<std::uint32_t>(instant));
    }
  };
  struct Tile {
    std::vector<Entry> entries;  // in order of time
    std::size_t dropped = 0;     // entries at the front that are forgotten

    /// The first that is not before `t`, of those from `from` on.
    std::vector<Entry>::const_iterator NotBefore(TimeNs t, std::vector<Entry>::const_iterator from) const;
  };

  std::span<const Entry> Between(std::size_t tile, TimeNs begin, TimeNs end) const;

  int width_;
  int height_;
  std::size_t columns_;  // of tiles
  std::size_t rows_;
  std::vector<Tile> tiles_;  // row-major
  bool empty_ = true;        // nothing has been appended
  TimeNs oldest_ = 0;        // events before this are forgotten
  TimeNs newest_ = 0;
};

}  // namespace evo
