#pragma once

#include <cstdint>

#include "evo/core/parameters.hpp"

namespace evo::events {

struct FlickerOptions {
  bool remove = true;
  double min_frequency_hz = 80.0;
  double max_frequency_hz = 400.0;
};

/// Adds `events.flicker.*`.
void Register(Parameters& parameters, FlickerOptions& options);

/// What a FlickerFilter has seen so far.
struct FlickerStatistics {
  double frequency_hz = 0.0;         ///< of most flickering events; 0: no flicker
  std::uint64_t events = 0;          ///< read
  std::uint64_t flicker_events = 0;  ///< read in flickering tiles
  std::uint64_t replaced_by = 0;     ///< given in their place
  double tile_ratio = 0.0;           ///< flickering tiles over all tiles, mean over time
};

}  // namespace evo::events
