#pragma once

#include <functional>
#include <vector>

#include "evo/core/parallel.hpp"
#include "evo/events/event_history.hpp"
#include "evo/geometry/camera.hpp"
#include "evo/io/event_reader.hpp"
#include "evo/io/tracks.hpp"
#include "evo/tracking/track_buffer.hpp"
#include "evo/tracking/tracker_options.hpp"

namespace evo {

/// What a stream held, beside its tracks.
struct TrackingResult {
  std::vector<TimeNs> frames;  ///< stamps of all event frames
  std::size_t events = 0;
  std::size_t key_frames = 0;  ///< frames where features were detected
};

/// What an observer of the tracker sees after each event frame, to draw it.
struct TrackingView {
  const EventHistory& history;
  const Tracks& tracks;  ///< their last frames, before shake is given back
  TimeNs t;
};

/// Tracks features through a whole stream of events: event frames every `frame_interval_s` from the first event of the
/// stream, each as soon as the stream holds the events that the tracker of `options.method` needs. `sink` takes the
/// tracks, of features seen in two event frames at least, as soon as they are final, see TrackBuffer. Memory does not
/// grow with the length of the stream but for the stamps. Throws Error (kNothingToDo) if the stream is shorter than one
/// window.
TrackingResult TrackEvents(EventReader* reader, const Camera& camera, const TrackerOptions& options, ThreadPool* pool,
                           const TrackSink& sink, const std::function<void(double)>& progress,
                           const std::function<void(const TrackingView&)>& observe = {});

}  // namespace evo
