#pragma once

#include <cstdint>
#include <vector>

#include "evo/core/parameters.hpp"
#include "evo/core/time.hpp"

namespace evo::events {

/// A pixel that fires by itself.
struct HotPixel {
  std::uint16_t x = 0;       ///< px, raw sensor column
  std::uint16_t y = 0;       ///< px, raw sensor row
  TimeNs first = 0;          ///< stamp of the first event that was left out
  TimeNs last = 0;           ///< stamp of the last one
  std::uint64_t events = 0;  ///< number of events that were left out

  /// Events/s from the first to the last; 0 with fewer than two.
  double Rate() const {
    return events < 2 || last <= first ? 0.0 : static_cast<double>(events - 1) / ToSeconds(last - first);
  }
};

struct HotPixelOptions {
  bool detect = true;
  double min_rate_hz = 12.0;
  double rate_ratio = 3.0;
  double look_ahead_s = 1.0;
};

/// Adds `events.hot_pixels.*`.
void Register(Parameters& parameters, HotPixelOptions& options);

}  // namespace evo::events
