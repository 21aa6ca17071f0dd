#pragma once

#include <compare>
#include <cstdint>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/events/event_columns.hpp"

namespace evo::simulation {

/// Merges the events of the tiles into one stream in the order (t, y, x).
class EventMerger {
 public:
  /// Adds a tile's events in any order. Events before time 0 belong to the lead-in and are dropped.
  void Add(const events::EventColumns& events);

  /// Removes and returns the events before `end`. The reference is valid until the next call.
  const events::EventColumns& TakeBefore(TimeNs end);

 private:
  struct Event {
    TimeNs t;
    std::uint16_t y;
    std::uint16_t x;
    std::int8_t polarity;
    auto operator<=>(const Event&) const = default;
  };
  std::vector<Event> pending_;
  events::EventColumns batch_;
};

}  // namespace evo::simulation
