#include "events/flicker/flicker_filter.hpp"

#include <algorithm>
#include <cmath>
#include <compare>
#include <limits>
#include <utility>
#include <vector>

#include "evo/core/parameters.hpp"

namespace evo::events {

namespace {

constexpr TimeNs kEver = std::numeric_limits<TimeNs>::max();

/// Appends event `i` of `from`.
void AppendEvent(const EventColumns& from, std::size_t i, EventColumns* to) {
  to->push_back(from.t[i], from.x[i], from.y[i], from.polarity[i]);
}

void AppendAll(const EventColumns& from, EventColumns* to) {
  to->t.insert(to->t.end(), from.t.begin(), from.t.end());
  to->x.insert(to->x.end(), from.x.begin(), from.x.end());
  to->y.insert(to->y.end(), from.y.begin(), from.y.end());
  to->polarity.insert(to->polarity.end(), from.polarity.begin(), from.polarity.end());
}

void SortByTime(EventColumns* events) {
  struct Event {
    TimeNs t;
    std::uint16_t y, x;
    std::int8_t polarity;
    auto operator<=>(const Event&) const = default;
  };
  std::vector<Event> sorted(events->size());
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    sorted[i] = {events->t[i], events->y[i], events->x[i], events->polarity[i]};
  }
  std::ranges::sort(sorted);
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    events->t[i] = sorted[i].t;
    events->x[i] = sorted[i].x;
    events->y[i] = sorted[i].y;
    events->polarity[i] = sorted[i].polarity;
  }
}

/// Forgets the first `count` events.
void DropFront(std::size_t count, EventColumns* events) {
  EventColumns rest;
  for (std::size_t i = count; i < events->size(); ++i) AppendEvent(*events, i, &rest);
  std::swap(*events, rest);
}

}  // namespace

void Register(Parameters& p, FlickerOptions& o) {
  p.Add("events.flicker.remove", &o.remove, "remove the events of lamps that flicker");
  p.Add("events.flicker.min_frequency_hz", &o.min_frequency_hz, 50.0, 450.0,
        "minimum frequency of flicker; twice that of the mains is 100 or 120 (Hz)");
  p.Add("events.flicker.max_frequency_hz", &o.max_frequency_hz, 50.0, 450.0, "maximum frequency of flicker (Hz)");
}

FlickerFilter::FlickerFilter(int width, int height, const FlickerOptions& options)
    : tiles_(width, height), remove_(options.remove), detector_(width, height, options), comb_(width, height) {}

void FlickerFilter::Apply(EventColumns* block) {
  if (!remove_ || block->empty()) return;
  statistics_.events += block->size();
  detector_.Add(*block, &segments_);
  waiting_.push_back(std::move(*block));
  *block = {};
  while (!waiting_.empty() && !segments_.empty() && waiting_.front().t.back() < segments_.back().end) {
    Filter(std::move(waiting_.front()), block);
    waiting_.pop_front();
  }
}

void FlickerFilter::Finish(EventColumns* block) {
  block->clear();
  if (!remove_) return;
  segments_.push_back(detector_.Last());
  if (!waiting_.empty()) last_ = waiting_.back().t.back();
  for (EventColumns& events : waiting_) Filter(std::move(events), block);
  if (has_segment_) AddDuration(last_);
  waiting_.clear();
  comb_.SetActive(0, 0, {});
  Merge(kEver, block);
}

FlickerStatistics FlickerFilter::statistics() const {
  FlickerStatistics s = statistics_;
  const double tiles = static_cast<double>(tiles_.size()) * duration_s_;
  s.tile_ratio = tiles > 0.0 ? tile_seconds_ / tiles : 0.0;
  s.frequency_hz = s.flicker_events > 0 ? frequency_sum_ / static_cast<double>(s.flicker_events) : 0.0;
  return s;
}

void FlickerFilter::Filter(EventColumns&& events, EventColumns* out) {
  if (!AnyFlickers(events.t.back())) {
    EnterSegmentOf(events.t.front());
    if (out->empty()) {
      *out = std::move(events);
    } else {
      AppendAll(events, out);
    }
    return;
  }
  for (std::size_t i = 0; i < events.size(); ++i) {
    const TimeNs t = events.t[i];
    if (!has_segment_ || t >= segment_end_) EnterSegmentOf(t);
    if (comb_.any_active()) comb_.AdvanceTo(t, &replaced_);
    const std::size_t tile = tiles_.TileOf(events.x[i], events.y[i]);
    if (comb_.any_active() && comb_.IsActive(tile)) {
      comb_.Add(tile, events.x[i], events.y[i], events.polarity[i]);
      ++in_segment_;
    } else {
      AppendEvent(events, i, &passed_);
    }
  }
  CountEvents();
  Merge(comb_.any_active() ? comb_.ready() : kEver, out);
}

bool FlickerFilter::AnyFlickers(TimeNs t) const {
  if (comb_.any_active() || !passed_.empty() || !replaced_.empty()) return true;
  for (const FlickerSegment& segment : segments_) {
    if (!segment.tiles.empty()) return true;
    if (t < segment.end) break;
  }
  return false;
}

void FlickerFilter::EnterSegmentOf(TimeNs t) {
  while (segments_.size() > 1 && t >= segments_.front().end) segments_.pop_front();
  const FlickerSegment& segment = segments_.front();
  CountEvents();
  if (has_segment_) AddDuration(t);
  segment_begin_ = t;
  flickering_tiles_ = segment.tiles.size();
  const TimeNs period = segment.tiles.empty() ? 0 : FromSeconds(1.0 / segment.frequency_hz);
  frequency_hz_ = segment.frequency_hz;
  comb_.SetActive(t, period, segment.tiles);
  segment_end_ = segment.end;
  has_segment_ = true;
}

void FlickerFilter::CountEvents() {
  statistics_.flicker_events += in_segment_;
  frequency_sum_ += frequency_hz_ * static_cast<double>(in_segment_);
  in_segment_ = 0;
}

void FlickerFilter::AddDuration(TimeNs end) {
  const double duration_s = ToSeconds(end - segment_begin_);
  duration_s_ += duration_s;
  tile_seconds_ += duration_s * static_cast<double>(flickering_tiles_);
}

void FlickerFilter::Merge(TimeNs end, EventColumns* out) {
  SortByTime(&replaced_);
  std::size_t i = 0;
  std::size_t j = 0;
  while (true) {
    const TimeNs passed = i < passed_.size() ? passed_.t[i] : kEver;
    const TimeNs replaced = j < replaced_.size() ? replaced_.t[j] : kEver;
    if (std::min(passed, replaced) >= end) break;
    passed <= replaced ? AppendEvent(passed_, i++, out) : AppendEvent(replaced_, j++, out);
  }
  statistics_.replaced_by += j;
  DropFront(i, &passed_);
  DropFront(j, &replaced_);
}

}  // namespace evo::events
