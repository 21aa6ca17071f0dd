#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "evo/core/time.hpp"

namespace evo {

/// Where a feature was at one instant, in raw (distorted) sensor pixels.
struct TrackObservation {
  std::int64_t id = 0;
  TimeNs t = 0;
  double x = 0.0;  ///< px
  double y = 0.0;  ///< px
};

/// Sorted by time, then id.
using Tracks = std::vector<TrackObservation>;

}  // namespace evo
