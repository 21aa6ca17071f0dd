#include "tracking/smoothing/track_buffer.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "tracking/smoothing/camera_shake.hpp"
#include "tracking/tracker.hpp"

namespace evo::tracking {

namespace {

constexpr std::size_t kStretchesAtOnce = 2;  // side by side

}  // namespace

TrackBuffer::TrackBuffer(const geometry::Camera& camera, const TrackerOptions& options, ThreadPool* pool,
                         events::TrackSink sink)
    : camera_(camera),
      lens_(camera),
      restore_shake_(options.rotation_spline),
      pool_(pool),
      sink_(std::move(sink)),
      delay_(std::max(kShakeMargin, kOldestWithdrawn * FromSeconds(options.frame_interval_s))) {}

void TrackBuffer::Add(TimeNs t, const events::Tracks& observations, std::span<const ObservedWindow> windows,
                      std::span<const std::int64_t> withdrawn) {
  if (!from_ && !observations.empty()) from_ = t;
  held_.insert(held_.end(), observations.begin(), observations.end());
  windows_.insert(windows_.end(), windows.begin(), windows.end());
  for (const auto id : withdrawn) withdrawn_[id] = t;
  std::vector<std::int64_t> ids;
  for (const auto& observation : observations) ids.push_back(observation.id);
  WithdrawLone(ids);
  ids_before_ = std::exchange(last_ids_, std::move(ids));
  last_ = t;
  while (from_ && t - *from_ >= static_cast<TimeNs>(kStretchesAtOnce) * kShakeStretch + delay_) {
    Release(kStretchesAtOnce);
  }
}

void TrackBuffer::Finish() {
  WithdrawLone({});
  if (from_) Release(static_cast<std::size_t>((last_ - *from_) / kShakeStretch) + 1);
}

void TrackBuffer::WithdrawLone(const std::vector<std::int64_t>& newest) {
  for (const auto id : last_ids_) {
    if (std::ranges::binary_search(ids_before_, id) || std::ranges::binary_search(newest, id)) continue;
    withdrawn_[id] = last_;
  }
}

void TrackBuffer::Release(std::size_t stretches) {
  const auto begin_of = [&](std::size_t stretch) { return *from_ + static_cast<TimeNs>(stretch) * kShakeStretch; };
  std::vector<events::Tracks> parts(stretches);
  pool_->ForEach(stretches, [&](std::size_t i) {
    const std::size_t first = IndexOf(begin_of(i) - kShakeMargin);
    const std::size_t begin = IndexOf(begin_of(i));
    const std::size_t end = IndexOf(begin_of(i + 1));
    const std::size_t count = IndexOf(begin_of(i + 1) + kShakeMargin) - first;
    parts[i].assign(held_.begin() + begin, held_.begin() + end);
    if (!restore_shake_) return;
    RestoreShake(camera_, lens_, std::span(held_).subspan(first, count), std::span(windows_).subspan(first, count),
                 begin - first, parts[i]);
  });
  for (events::Tracks& part : parts) {
    std::erase_if(part,
                  [&](const events::TrackObservation& observation) { return withdrawn_.contains(observation.id); });
    sink_(std::move(part));
  }
  from_ = begin_of(stretches);
  std::erase_if(withdrawn_, [&](const auto& feature) { return feature.second < *from_; });
  const auto passed = static_cast<std::ptrdiff_t>(IndexOf(*from_ - kShakeMargin));
  held_.erase(held_.begin(), held_.begin() + passed);
  windows_.erase(windows_.begin(), windows_.begin() + passed);
}

std::size_t TrackBuffer::IndexOf(TimeNs t) const {
  return static_cast<std::size_t>(
      std::distance(held_.begin(), std::ranges::lower_bound(held_, t, {}, &events::TrackObservation::t)));
}

}  // namespace evo::tracking
