#include "evo/tracking/track_events.hpp"

#include <algorithm>
#include <future>
#include <opencv2/core/utility.hpp>

#include "evo/core/error.hpp"
#include "evo/core/format.hpp"
#include "tracking/smoothing/track_buffer.hpp"
#include "tracking/tracker.hpp"

namespace evo::tracking {

TrackingResult TrackEvents(events::EventReader* reader, const geometry::Camera& camera, const TrackerOptions& options,
                           ThreadPool* pool, const events::TrackSink& sink, const std::function<void(double)>& progress,
                           const std::function<void(const TrackingView&)>& observe) {
  // Its variants for newer processors round differently: the tracks would depend on the machine.
  cv::setUseOptimized(false);
  cv::setNumThreads(1);  // the pool's threads are all that were asked for
  events::EventHistory history(camera.width(), camera.height());
  const std::unique_ptr<Tracker> tracker = MakeTracker(camera, options, pool);
  TrackBuffer buffer(camera, options, pool, sink);
  TrackingResult result;
  const TimeNs interval = FromSeconds(options.frame_interval_s);
  const TimeNs half_window = FromSeconds(0.5 * options.max_window_s);

  const auto process = [&](TimeNs t, const std::function<void()>& read_ahead) {
    history.DropBefore(t - tracker->before());
    tracker->Process(history, t, read_ahead);
    result.frames.push_back(t);
    if (tracker->detected()) ++result.key_frames;
    buffer.Add(t, tracker->Observations(), tracker->Windows(), tracker->Withdrawn());
    if (observe) observe({history, buffer.held(), t});
  };

  // One block is decoded while the one before it is tracked.
  events::EventColumns block, next;
  const auto read = [&] { return reader->Next(&next); };
  std::future<bool> pending = std::async(std::launch::async, read);
  std::optional<TimeNs> frame;
  TimeNs last = 0;
  while (pending.get()) {
    std::swap(block, next);
    pending = std::async(std::launch::async, read);
    if (block.empty()) continue;
    // The first frame has half a window of events on either side.
    if (!frame) frame = block.t.front() + std::min(half_window, interval);
    last = block.t.back();
    result.events += block.size();
    std::size_t appended = 0;
    // No further than a frame sees: the fewer events there are, the faster those of a patch are found.
    const auto append_for = [&](TimeNs t) {
      const auto visible = std::ranges::upper_bound(block.t, t + tracker->after());
      const auto end = static_cast<std::size_t>(visible - block.t.begin());
      history.Append(block, appended, end);
      appended = end;
    };
    append_for(*frame);
    for (; appended < block.size(); *frame += interval, append_for(*frame)) {
      process(*frame, [&] { append_for(*frame + interval); });
    }
    if (progress) progress(reader->progress());
  }
  if (frame) {
    for (; *frame <= last; *frame += interval) process(*frame, [] {});
  }
  if (result.frames.size() < 2) {
    throw Error(
        ErrorKind::kNothingToDo,
        "the events span less than two event frames; choose a longer interval or a smaller tracker.frame_interval_s");
  }
  buffer.Finish();
  return result;
}

std::string DescribePositions(const TrackerOptions& options) {
  if (options.method != "klt") return "pixels of the raw sensor, each at the very instant of its stamp";
  return Format(
      "pixels of the raw sensor, in the image of the newest %d events, so late by half the time that these take",
      options.klt.events);
}

}  // namespace evo::tracking
