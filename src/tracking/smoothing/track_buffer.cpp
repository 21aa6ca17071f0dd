#include "tracking/smoothing/track_buffer.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "tracking/smoothing/rotation_spline.hpp"
#include "tracking/tracker.hpp"

namespace evo::tracking {

namespace {

constexpr std::size_t kSegmentsAtOnce = 2;  // in parallel; more would delay the output and take more memory

}  // namespace

TrackBuffer::TrackBuffer(const geometry::Camera& camera, const TrackerOptions& options, ThreadPool* pool,
                         events::TrackSink sink)
    : camera_(camera),
      jacobians_(camera),
      rotation_spline_(options.rotation_spline),
      pool_(pool),
      sink_(std::move(sink)),
      delay_(std::max(kSplineMargin, kMaxRejectionAge * FromSeconds(options.frame_interval_s))) {}

void TrackBuffer::Add(TimeNs t, const events::Tracks& observations, std::span<const ObservedWindow> windows,
                      std::span<const std::int64_t> rejected) {
  if (!from_ && !observations.empty()) from_ = t;
  held_.insert(held_.end(), observations.begin(), observations.end());
  windows_.insert(windows_.end(), windows.begin(), windows.end());
  for (const auto id : rejected) rejected_[id] = t;
  std::vector<std::int64_t> ids;
  for (const auto& observation : observations) ids.push_back(observation.id);
  RejectSingleObservations(ids);
  previous_ids_ = std::exchange(last_ids_, std::move(ids));
  last_ = t;
  while (from_ && t - *from_ >= static_cast<TimeNs>(kSegmentsAtOnce) * kSplineSegment + delay_) {
    Release(kSegmentsAtOnce);
  }
}

void TrackBuffer::Finish() {
  RejectSingleObservations({});
  if (from_) Release(static_cast<std::size_t>((last_ - *from_) / kSplineSegment) + 1);
}

void TrackBuffer::RejectSingleObservations(const std::vector<std::int64_t>& newest) {
  for (const auto id : last_ids_) {
    if (std::ranges::binary_search(previous_ids_, id) || std::ranges::binary_search(newest, id)) continue;
    rejected_[id] = last_;
  }
}

void TrackBuffer::Release(std::size_t segments) {
  const auto begin_of = [&](std::size_t segment) { return *from_ + static_cast<TimeNs>(segment) * kSplineSegment; };
  std::vector<events::Tracks> parts(segments);
  pool_->ForEach(segments, [&](std::size_t i) {
    const std::size_t first = FirstIndexFrom(begin_of(i) - kSplineMargin);
    const std::size_t begin = FirstIndexFrom(begin_of(i));
    const std::size_t end = FirstIndexFrom(begin_of(i + 1));
    const std::size_t count = FirstIndexFrom(begin_of(i + 1) + kSplineMargin) - first;
    parts[i].assign(held_.begin() + begin, held_.begin() + end);
    if (!rotation_spline_) return;
    RestoreRotation(camera_, jacobians_, std::span(held_).subspan(first, count),
                    std::span(windows_).subspan(first, count), begin - first, parts[i]);
  });
  for (events::Tracks& part : parts) {
    std::erase_if(part,
                  [&](const events::TrackObservation& observation) { return rejected_.contains(observation.id); });
    sink_(std::move(part));
  }
  from_ = begin_of(segments);
  std::erase_if(rejected_, [&](const auto& feature) { return feature.second < *from_; });
  const auto released = static_cast<std::ptrdiff_t>(FirstIndexFrom(*from_ - kSplineMargin));
  held_.erase(held_.begin(), held_.begin() + released);
  windows_.erase(windows_.begin(), windows_.begin() + released);
}

std::size_t TrackBuffer::FirstIndexFrom(TimeNs t) const {
  return static_cast<std::size_t>(
      std::distance(held_.begin(), std::ranges::lower_bound(held_, t, {}, &events::TrackObservation::t)));
}

}  // namespace evo::tracking
