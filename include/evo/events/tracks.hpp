#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "evo/core/time.hpp"

namespace evo::events {

/// The position of a feature at one instant, in raw (distorted) sensor pixels.
struct TrackObservation {
  std::int64_t id = 0;
  TimeNs t = 0;
  double x = 0.0;  ///< px
  double y = 0.0;  ///< px
  bool operator==(const TrackObservation&) const = default;
};

/// Observations ordered by time, then id, with at most one for each id and stamp.
using Tracks = std::vector<TrackObservation>;

/// Takes the next observations, ordered by time, then id.
using TrackSink = std::function<void(Tracks)>;

}  // namespace evo::events
