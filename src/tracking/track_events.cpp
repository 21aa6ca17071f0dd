#include "evo/tracking/track_events.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <opencv2/core/utility.hpp>
#include <optional>
#include <utility>

#include "evo/core/error.hpp"
#include "evo/events/block_prefetcher.hpp"
#include "tracking/smoothing/track_buffer.hpp"
#include "tracking/tracker.hpp"

namespace evo::tracking {

namespace {

/// Runs a tracker over the event frames of a stream that arrives in blocks.
class FrameSequence {
 public:
  FrameSequence(const geometry::Camera& camera, const TrackerOptions& options, ThreadPool* pool,
                const events::TrackSink& sink, const std::function<void(const TrackingView&)>& observe)
      : interval_(FromSeconds(options.frame_interval_s)),
        half_window_(FromSeconds(0.5 * options.max_window_s)),
        pool_(pool),
        observe_(observe),
        history_(camera.width(), camera.height()),
        tracker_(MakeTracker(camera, options, pool)),
        buffer_(camera, options, pool, sink) {}

  /// Processes all frames whose events have arrived with this block.
  void Add(const events::EventColumns& block) {
    if (block.empty()) return;
    // The first frame has half a window of events on either side.
    if (!frame_) frame_ = block.t.front() + std::min(half_window_, interval_);
    last_event_ = block.t.back();
    result_.events += block.size();
    std::size_t appended = 0;
    // The history holds no more than a frame needs: the fewer its events, the faster a patch finds its own.
    const auto append_for = [&](TimeNs frame) {
      const auto end = std::ranges::upper_bound(block.t, frame + tracker_->after());
      const auto count = static_cast<std::size_t>(end - block.t.begin());
      history_.Append(block, appended, count);
      appended = count;
    };
    append_for(*frame_);
    while (appended < block.size()) {
      ProcessFrame([&] { append_for(*frame_ + interval_); });
      *frame_ += interval_;
    }
  }

  /// Processes the last frames, whose windows the stream's end cuts.
  TrackingResult Finish() {
    for (; frame_ && *frame_ <= last_event_; *frame_ += interval_) ProcessFrame([] {});
    if (result_.frames.size() < 2) {
      throw Error(ErrorKind::kNothingToDo,
                  "the events span less than two event frames; choose a longer interval or a smaller "
                  "tracker.frame_interval_s");
    }
    buffer_.Finish();
    return std::move(result_);
  }

 private:
  /// `append_next` appends the events of the next frame to the history.
  void ProcessFrame(const std::function<void()>& append_next) {
    const TimeNs t = *frame_;
    history_.DropBefore(t - tracker_->before());
    tracker_->Track(history_, t);
    // The estimate of the camera's motion reads no events, and neither of the two can be divided among threads.
    pool_->ForEach(2, [&](std::size_t i) { i == 0 ? tracker_->EstimateMotion() : append_next(); });
    tracker_->UpdateFeatures(history_);

    result_.frames.push_back(t);
    if (tracker_->is_key_frame()) ++result_.key_frames;
    buffer_.Add(t, tracker_->Observations(), tracker_->Windows(), tracker_->Rejected());
    if (observe_) observe_({history_, buffer_.held(), t});
  }

  TimeNs interval_;
  TimeNs half_window_;
  ThreadPool* pool_;
  const std::function<void(const TrackingView&)>& observe_;
  events::EventHistory history_;
  std::unique_ptr<Tracker> tracker_;
  TrackBuffer buffer_;
  std::optional<TimeNs> frame_;  // stamp of the next frame; empty before the first event
  TimeNs last_event_ = 0;
  TrackingResult result_;
};

}  // namespace

TrackingResult TrackEvents(events::EventReader* reader, const geometry::Camera& camera, const TrackerOptions& options,
                           ThreadPool* pool, const events::TrackSink& sink, const std::function<void(double)>& progress,
                           const std::function<void(const TrackingView&)>& observe) {
  // OpenCV's code for newer processors rounds differently: the tracks would depend on the machine.
  cv::setUseOptimized(false);
  cv::setNumThreads(1);  // the pool has all the threads that were asked for
  FrameSequence sequence(camera, options, pool, sink, observe);
  events::BlockPrefetcher blocks(reader);
  events::EventColumns block;
  while (blocks.Next(&block)) {
    sequence.Add(block);
    if (progress && !block.empty()) progress(blocks.progress());
  }
  return sequence.Finish();
}

std::string DescribePositions(const TrackerOptions& options) {
  if (options.method != "klt") return "pixels of the raw sensor, each at the very instant of its stamp";
  return fmt::format(
      "pixels of the raw sensor, in the image of the newest {} events, so late by half the time that these take",
      options.klt.events);
}

}  // namespace evo::tracking
