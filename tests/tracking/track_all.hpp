#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "evo/tracking/track_events.hpp"
#include "tracking/synthetic_events.hpp"

namespace evo::tracking::testing {

struct TrackedStream : TrackingResult {
  events::Tracks tracks;
};

/// All tracks in the events that SceneCamera() sees.
inline TrackedStream TrackAll(const events::EventColumns& events, const TrackerOptions& options, int threads = 1) {
  MemoryReader reader(events);
  ThreadPool pool(threads);
  events::Tracks tracks;
  const auto keep = [&](const events::Tracks& next) { tracks.insert(tracks.end(), next.begin(), next.end()); };
  TrackedStream stream{TrackEvents(&reader, SceneCamera(), options, &pool, keep, {}), {}};
  stream.tracks = std::move(tracks);
  return stream;
}

using TracksById = std::map<std::int64_t, std::vector<events::TrackObservation>>;

inline TracksById ById(const events::Tracks& tracks) {
  TracksById by_id;
  for (const auto& observation : tracks) by_id[observation.id].push_back(observation);
  return by_id;
}

}  // namespace evo::tracking::testing
