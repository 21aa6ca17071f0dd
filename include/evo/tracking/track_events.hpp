#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "evo/core/parallel.hpp"
#include "evo/events/event_history.hpp"
#include "evo/events/event_reader.hpp"
#include "evo/events/tracks.hpp"
#include "evo/geometry/camera.hpp"
#include "evo/tracking/tracker_options.hpp"

namespace evo::tracking {

/// Counts of a tracked stream.
struct TrackingResult {
  std::vector<TimeNs> frames;  ///< stamps of all event frames
  std::size_t events = 0;
  std::size_t key_frames = 0;  ///< frames in which new features were detected
};

/// The state of the tracker after an event frame, for drawings.
struct TrackingView {
  const events::EventHistory& history;
  const events::Tracks& tracks;  ///< the last seconds, before their fast rotation is restored (see TrackBuffer)
  TimeNs t;                      ///< stamp of the event frame
};

/// Tracks features through a stream of events. Event frames follow one another every `frame_interval_s` from the first
/// event on; each is processed as soon as the stream has delivered its events. `sink` takes the observations of
/// features with at least two of them once they are final (see TrackBuffer). Memory does not grow with the length of
/// the stream, except for the stamps of the frames. Throws Error (kNothingToDo) if the stream spans fewer than two
/// frames.
TrackingResult TrackEvents(events::EventReader* reader, const geometry::Camera& camera, const TrackerOptions& options,
                           ThreadPool* pool, const events::TrackSink& sink, const std::function<void(double)>& progress,
                           const std::function<void(const TrackingView&)>& observe = {});

/// One line for the head of a track file: which instant the positions of the tracker belong to.
std::string DescribePositions(const TrackerOptions& options);

}  // namespace evo::tracking
