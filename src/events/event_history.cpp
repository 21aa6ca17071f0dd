#include "evo/events/event_history.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

namespace evo::events {

namespace {

// By which the ends of a moving patch are widened, so that rounding loses none of its events.
constexpr double kRoundingPx = 1e-3;

std::size_t ClampTile(double px, std::size_t tiles) {
  const double tile = std::floor(px / EventHistory::kTilePx);
  return static_cast<std::size_t>(std::clamp(tile, 0.0, static_cast<double>(tiles) - 1.0));
}

}  // namespace

void LocalEvents::resize(std::size_t count) {
  x.resize(count);
  y.resize(count);
  dt.resize(count);
  polarity.resize(count);
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
  resize(count);
}

EventHistory::EventHistory(int width, int height)
    : width_(width),
      height_(height),
      columns_(static_cast<std::size_t>((width + kTilePx - 1) / kTilePx)),
      rows_(static_cast<std::size_t>((height + kTilePx - 1) / kTilePx)) {}

void EventHistory::Append(const EventColumns& events, std::size_t begin, std::size_t end) {
  while (begin < end) {
    const TimeNs t = events.t[begin];
    if (!origin_) origin_ = t;
    const TimeNs slice = t - (t - *origin_) % kSlice;
    const auto from = events.t.begin();
    const auto next = std::lower_bound(from + static_cast<std::ptrdiff_t>(begin),
                                       from + static_cast<std::ptrdiff_t>(end), slice + kSlice) -
                      from;
    AddToSlice(slice, events, begin, static_cast<std::size_t>(next));
    begin = static_cast<std::size_t>(next);
  }
}

void EventHistory::AddToSlice(TimeNs t, const EventColumns& events, std::size_t begin, std::size_t end) {
  const std::size_t tiles = columns_ * rows_;
  if (slices_.empty() || slices_.back().begin != t) {
    if (spare_.empty()) {
      slices_.emplace_back();
    } else {
      slices_.push_back(std::move(spare_.back()));
      spare_.pop_back();
    }
    slices_.back().begin = t;
    slices_.back().entries.clear();
    slices_.back().starts.assign(tiles + 1, 0);
  }
  Slice& slice = slices_.back();
  next_.assign(tiles, 0);
  for (std::size_t i = begin; i < end; ++i) ++next_[TileOf(events.x[i], events.y[i])];
  merged_.resize(slice.entries.size() + end - begin);
  std::uint32_t at = 0;
  std::uint32_t before = 0;  // where the tile began
  for (std::size_t tile = 0; tile < tiles; ++tile) {
    const std::uint32_t before_end = slice.starts[tile + 1];
    slice.starts[tile] = at;
    if (before != before_end) {
      std::copy(slice.entries.begin() + before, slice.entries.begin() + before_end, merged_.begin() + at);
      at += before_end - before;
    }
    const std::uint32_t added = next_[tile];
    next_[tile] = at;
    at += added;
    before = before_end;
  }
  slice.starts[tiles] = at;
  for (std::size_t i = begin; i < end; ++i) {
    const auto after = static_cast<std::uint32_t>(events.t[i] - t);
    merged_[next_[TileOf(events.x[i], events.y[i])]++] = {2 * after + (events.polarity[i] > 0 ? 1 : 0), events.x[i],
                                                          events.y[i]};
  }
  std::swap(slice.entries, merged_);
}

void EventHistory::DropBefore(TimeNs t) {
  oldest_ = std::max(oldest_, t);
  while (!slices_.empty() && slices_.front().begin + kSlice <= t) {
    spare_.push_back(std::move(slices_.front()));
    slices_.pop_front();
  }
}

std::size_t EventHistory::SliceAfter(TimeNs t) const {
  const auto slice = std::ranges::upper_bound(slices_, t, {}, [](const Slice& s) { return s.begin + kSlice; });
  return static_cast<std::size_t>(slice - slices_.begin());
}

TimeNs EventHistory::BeginOfNewest(TimeNs begin, TimeNs end, std::size_t count) const {
  std::vector<TimeNs> stamps;
  ForEachBetween(begin, end, [&](int, int, TimeNs t, std::int8_t) { stamps.push_back(t); });
  if (stamps.empty() || count == 0) return end;
  const auto first = stamps.begin() + static_cast<std::ptrdiff_t>(std::min(count, stamps.size()) - 1);
  std::ranges::nth_element(stamps, first, std::greater<>());
  return *first;
}

void EventHistory::Gather(const MovingPatch& patch, LocalEvents* local) const {
  if (patch.half_window > kLongestHalfWindow) throw std::length_error("too long a window of events");
  const auto cx = static_cast<float>(patch.x);
  const auto cy = static_cast<float>(patch.y);
  const auto vx = static_cast<float>(patch.vx);
  const auto vy = static_cast<float>(patch.vy);
  const auto radius = static_cast<float>(patch.radius);
  const TimeNs begin = std::max(patch.t - patch.half_window, oldest_);
  const TimeNs last = patch.t + patch.half_window;

  /// Entries of a slice that lie side by side.
  struct Run {
    std::span<const Entry> entries;
    std::int32_t since;        // ns from the instant asked for to the slice's begin
    std::int32_t first, last;  // of the stamps in the window
  };
  // All runs first, so that they are on their way into the cache.
  thread_local std::vector<Run> runs;
  runs.clear();
  std::size_t visited = 0;
  for (std::size_t i = SliceAfter(begin); i < slices_.size() && slices_[i].begin <= last; ++i) {
    const Slice& slice = slices_[i];
    const TimeNs slice_begin = std::max(slice.begin, begin);
    const TimeNs slice_last = std::min(slice.begin + kSlice - 1, last);
    // The patch while the slice lasts.
    const double middle_s = ToSeconds((slice_begin - patch.t + slice_last - patch.t) / 2);
    const double reach_s = 0.5 * ToSeconds(slice_last - slice_begin);
    const double centre_x = patch.x + middle_s * patch.vx;
    const double centre_y = patch.y + middle_s * patch.vy;
    const double reach_x = patch.radius + reach_s * std::abs(patch.vx) + kRoundingPx;
    const double reach_y = patch.radius + reach_s * std::abs(patch.vy) + kRoundingPx;
    const std::size_t column_begin = ClampTile(centre_x - reach_x, columns_);
    const std::size_t column_end = ClampTile(centre_x + reach_x, columns_) + 1;
    const std::size_t row_begin = ClampTile(centre_y - reach_y, rows_);
    const std::size_t row_end = ClampTile(centre_y + reach_y, rows_) + 1;
    for (std::size_t row = row_begin; row < row_end; ++row) {
      const auto entries = slice.Of(row * columns_ + column_begin, row * columns_ + column_end);
      if (entries.empty()) continue;
      __builtin_prefetch(entries.data());
      runs.push_back({entries, static_cast<std::int32_t>(slice.begin - patch.t),
                      static_cast<std::int32_t>(slice_begin - slice.begin),
                      static_cast<std::int32_t>(slice_last - slice.begin)});
      visited += entries.size();
    }
  }
  // Of a size that never shrinks, as growing sets what it adds to zero.
  thread_local LocalEvents all;
  if (all.size() < visited + 1) all.resize(visited + 1);
  std::size_t count = 0;
  // Plain pointers, which a write of a polarity cannot change.
  float* const xs = all.x.data();
  float* const ys = all.y.data();
  float* const dts = all.dt.data();
  std::int8_t* const polarities = all.polarity.data();
  for (const Run& run : runs) {
    // Every event is written, but stays only if the next one does not overwrite it: no branch to mispredict.
    for (const Entry& entry : run.entries) {
      const std::int32_t after = entry.t();
      const float dt = 1e-9f * static_cast<float>(run.since + after);
      const float x = static_cast<float>(entry.x) - cx;
      const float y = static_cast<float>(entry.y) - cy;
      xs[count] = x;
      ys[count] = y;
      dts[count] = dt;
      polarities[count] = entry.polarity();
      const bool is_inside = (after >= run.first) & (after <= run.last) & (std::abs(x - vx * dt) <= radius) &
                             (std::abs(y - vy * dt) <= radius);
      count += is_inside ? 1 : 0;
    }
  }
  local->x.assign(xs, xs + count);
  local->y.assign(ys, ys + count);
  local->dt.assign(dts, dts + count);
  local->polarity.assign(polarities, polarities + count);
}

}  // namespace evo::events
