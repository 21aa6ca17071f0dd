#include "evo/events/event_history.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace evo {

namespace {

constexpr int kTilePx = 8;

/// Floor division for stamps of either sign.
TimeNs SliceBegin(TimeNs t, TimeNs duration) {
  const TimeNs remainder = t % duration;
  return t - (remainder < 0 ? remainder + duration : remainder);
}

std::size_t ClampTile(double px, std::size_t tiles) {
  const double tile = std::floor(px / kTilePx);
  return static_cast<std::size_t>(std::clamp(tile, 0.0, static_cast<double>(tiles) - 1.0));
}

}  // namespace

void LocalEvents::clear() {
  x.clear();
  y.clear();
  dt.clear();
  polarity.clear();
}

void LocalEvents::Thin(std::size_t count) {
  const std::size_t total = size();
  if (total <= count) return;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t from = i * total / count;
    x[i] = x[from];
    y[i] = y[from];
    dt[i] = dt[from];
    polarity[i] = polarity[from];
  }
  x.resize(count);
  y.resize(count);
  dt.resize(count);
  polarity.resize(count);
}

EventHistory::EventHistory(int width, int height, TimeNs slice_duration)
    : width_(width),
      height_(height),
      slice_duration_(slice_duration),
      tile_columns_(static_cast<std::size_t>((width + kTilePx - 1) / kTilePx)),
      tile_rows_(static_cast<std::size_t>((height + kTilePx - 1) / kTilePx)) {}

std::size_t EventHistory::TileOf(const Entry& entry) const {
  return (entry.y / kTilePx) * tile_columns_ + entry.x / kTilePx;
}

void EventHistory::Append(const EventColumns& events) {
  for (std::size_t i = 0; i < events.size(); ++i) {
    const TimeNs t = events.t[i];
    if (!pending_.empty() && t >= pending_begin_ + slice_duration_) Finish();
    if (pending_.empty()) pending_begin_ = SliceBegin(t, slice_duration_);
    pending_.push_back({static_cast<std::int32_t>(t - pending_begin_), events.x[i], events.y[i], events.polarity[i]});
  }
}

void EventHistory::Finish() {
  if (pending_.empty()) return;
  Slice slice;
  if (!spare_.empty()) {
    slice = std::move(spare_.back());
    spare_.pop_back();
  }
  slice.begin = pending_begin_;
  slice.tile_begin.assign(tile_columns_ * tile_rows_ + 1, 0);
  slice.entries.resize(pending_.size());
  // Counting sort: stable, so events stay in order of time within a tile.
  for (const Entry& entry : pending_) ++slice.tile_begin[TileOf(entry) + 1];
  for (std::size_t i = 1; i < slice.tile_begin.size(); ++i) slice.tile_begin[i] += slice.tile_begin[i - 1];
  std::vector<std::uint32_t>& next = slice.tile_begin;
  for (const Entry& entry : pending_) slice.entries[next[TileOf(entry)]++] = entry;
  // Every begin has moved on to its tile's end, which is the next tile's begin: shift back by one.
  std::rotate(next.rbegin(), next.rbegin() + 1, next.rend());
  next.front() = 0;
  slices_.push_back(std::move(slice));
  pending_.clear();
}

void EventHistory::DropBefore(TimeNs t) {
  while (!slices_.empty() && slices_.front().begin + slice_duration_ <= t) {
    spare_.push_back(std::move(slices_.front()));
    slices_.pop_front();
  }
}

TimeNs EventHistory::BeginOfNewest(TimeNs end, std::size_t count) const {
  std::vector<TimeNs> stamps;  // of the slice at hand
  for (auto slice = slices_.rbegin(); slice != slices_.rend() && count > 0; ++slice) {
    if (slice->begin >= end) continue;
    stamps.clear();
    for (const Entry& entry : slice->entries) {
      if (slice->begin + entry.offset_ns < end) stamps.push_back(slice->begin + entry.offset_ns);
    }
    if (count <= stamps.size()) {
      const auto first = stamps.begin() + static_cast<std::ptrdiff_t>(count - 1);
      std::ranges::nth_element(stamps, first, std::greater<>());
      return *first;
    }
    count -= stamps.size();
  }
  return slices_.empty() || count == 0 ? end : slices_.front().begin;
}

void EventHistory::Gather(const MovingPatch& patch, LocalEvents* local) const {
  local->clear();
  const TimeNs begin = patch.t - patch.half_window;
  const TimeNs end = patch.t + patch.half_window;
  const double reach = ToSeconds(patch.half_window);
  const double reach_x = patch.radius + std::abs(patch.vx) * reach;
  const double reach_y = patch.radius + std::abs(patch.vy) * reach;
  const std::size_t column_begin = ClampTile(patch.x - reach_x, tile_columns_);
  const std::size_t column_end = ClampTile(patch.x + reach_x, tile_columns_) + 1;
  const std::size_t row_begin = ClampTile(patch.y - reach_y, tile_rows_);
  const std::size_t row_end = ClampTile(patch.y + reach_y, tile_rows_) + 1;
  const auto cx = static_cast<float>(patch.x);
  const auto cy = static_cast<float>(patch.y);
  const auto vx = static_cast<float>(patch.vx);
  const auto vy = static_cast<float>(patch.vy);
  const auto radius = static_cast<float>(patch.radius);
  const auto half_window_s = static_cast<float>(reach);

  for (const Slice& slice : slices_) {
    if (slice.begin > end || slice.begin + slice_duration_ <= begin) continue;
    const auto slice_dt = static_cast<float>(ToSeconds(slice.begin - patch.t));
    for (std::size_t row = row_begin; row < row_end; ++row) {
      const std::uint32_t first = slice.tile_begin[row * tile_columns_ + column_begin];
      const std::uint32_t last = slice.tile_begin[row * tile_columns_ + column_end];
      for (std::uint32_t i = first; i < last; ++i) {
        const Entry& entry = slice.entries[i];
        const float dt = slice_dt + 1e-9f * static_cast<float>(entry.offset_ns);
        const float x = static_cast<float>(entry.x) - cx;
        const float y = static_cast<float>(entry.y) - cy;
        if (std::abs(x - vx * dt) > radius || std::abs(y - vy * dt) > radius || std::abs(dt) > half_window_s) continue;
        local->x.push_back(x);
        local->y.push_back(y);
        local->dt.push_back(dt);
        local->polarity.push_back(entry.polarity);
      }
    }
  }
}

}  // namespace evo
