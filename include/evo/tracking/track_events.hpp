#pragma once

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

/// What a stream held, beside its tracks.
struct TrackingResult {
  std::vector<TimeNs> frames;  ///< stamps of all event frames
  std::size_t events = 0;
  std::size_t key_frames = 0;  ///< frames where features were detected
};

/// What an observer of the tracker sees after each event frame, to draw it.
struct TrackingView {
  const events::EventHistory& history;
  const events::Tracks& tracks;  ///< their last frames, before shake is given back
  TimeNs t;
};

/// Tracks features through a whole stream of events: event frames every `frame_interval_s` from the first event of the
/// stream, each as soon as the stream holds the events that the tracker of `options.method` needs. `sink` takes the
/// tracks, of features seen in two event frames at least, as soon as they are final, see TrackBuffer. Memory does not
/// grow with the length of the stream but for the stamps. Throws Error (kNothingToDo) if the stream is shorter than one
/// window.
TrackingResult TrackEvents(events::EventReader* reader, const geometry::Camera& camera, const TrackerOptions& options,
                           ThreadPool* pool, const events::TrackSink& sink, const std::function<void(double)>& progress,
                           const std::function<void(const TrackingView&)>& observe = {});

/// What the positions of the tracker of `options.method` are, one line for the head of a track file.
std::string DescribePositions(const TrackerOptions& options);

}  // namespace evo::tracking
