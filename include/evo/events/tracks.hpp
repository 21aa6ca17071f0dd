#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "evo/core/time.hpp"

namespace evo::events {

/// Where a feature was at one instant, in raw (distorted) sensor pixels.
struct TrackObservation {
  std::int64_t id = 0;
  TimeNs t = 0;
  double x = 0.0;  ///< px
  double y = 0.0;  ///< px
  bool operator==(const TrackObservation&) const = default;
};

/// Sorted by time, then id; one observation for each id and stamp.
using Tracks = std::vector<TrackObservation>;

/// Takes the next observations of tracks, sorted by time, then id.
using TrackSink = std::function<void(Tracks)>;

}  // namespace evo::events
