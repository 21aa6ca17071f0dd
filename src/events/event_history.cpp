#include "evo/events/event_history.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>

namespace evo::events {

namespace {

// A moving patch is widened by this, so that rounding loses none of its events.
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

void LocalEvents::Subsample(std::size_t max_count) {
  const std::size_t total = size();
  if (total <= max_count) return;
  for (std::size_t i = 0; i < max_count; ++i) {
    const std::size_t from = i * total / max_count;
    x[i] = x[from];
    y[i] = y[from];
    dt[i] = dt[from];
    polarity[i] = polarity[from];
  }
  resize(max_count);
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
  if (slices_.empty() || slices_.back().begin != t) StartSlice(t);
  MakeRoom(events, begin, end);
  for (std::size_t i = begin; i < end; ++i) {
    const auto since_begin = static_cast<std::uint32_t>(events.t[i] - t);
    merged_[next_[TileIndex(events.x[i], events.y[i])]++] = {2 * since_begin + (events.polarity[i] > 0 ? 1 : 0),
                                                             events.x[i], events.y[i]};
  }
  std::swap(slices_.back().entries, merged_);
}

void EventHistory::StartSlice(TimeNs t) {
  if (spare_.empty()) {
    slices_.emplace_back();
  } else {
    slices_.push_back(std::move(spare_.back()));
    spare_.pop_back();
  }
  slices_.back().begin = t;
  slices_.back().entries.clear();
  slices_.back().starts.assign(columns_ * rows_ + 1, 0);
}

void EventHistory::MakeRoom(const EventColumns& events, std::size_t begin, std::size_t end) {
  // A counting sort by tile: first the number of new events in each tile, then the old entries with gaps after them.
  Slice& slice = slices_.back();
  const std::size_t tiles = columns_ * rows_;
  next_.assign(tiles, 0);
  for (std::size_t i = begin; i < end; ++i) ++next_[TileIndex(events.x[i], events.y[i])];
  merged_.resize(slice.entries.size() + end - begin);
  std::uint32_t place = 0;
  std::uint32_t old_start = 0;
  for (std::size_t tile = 0; tile < tiles; ++tile) {
    const std::uint32_t old_end = slice.starts[tile + 1];
    slice.starts[tile] = place;
    if (old_start != old_end) {
      std::copy(slice.entries.begin() + old_start, slice.entries.begin() + old_end, merged_.begin() + place);
      place += old_end - old_start;
    }
    const std::uint32_t added = next_[tile];
    next_[tile] = place;
    place += added;
    old_start = old_end;
  }
  slice.starts[tiles] = place;
}

void EventHistory::DropBefore(TimeNs t) {
  oldest_ = std::max(oldest_, t);
  while (!slices_.empty() && slices_.front().begin + kSlice <= t) {
    spare_.push_back(std::move(slices_.front()));
    slices_.pop_front();
  }
}

std::size_t EventHistory::FirstSliceEndingAfter(TimeNs t) const {
  const auto slice = std::ranges::upper_bound(slices_, t, {}, [](const Slice& s) { return s.begin + kSlice; });
  return static_cast<std::size_t>(slice - slices_.begin());
}

TimeNs EventHistory::NewestWindowBegin(TimeNs begin, TimeNs end, std::size_t count) const {
  std::vector<TimeNs> stamps;
  ForEachBetween(begin, end, [&](int, int, TimeNs t, std::int8_t) { stamps.push_back(t); });
  if (stamps.empty() || count == 0) return end;
  const auto first = stamps.begin() + static_cast<std::ptrdiff_t>(std::min(count, stamps.size()) - 1);
  std::ranges::nth_element(stamps, first, std::greater<>());
  return *first;
}

void EventHistory::FindRuns(const MovingPatch& patch, const Slice& slice, TimeNs begin, TimeNs last,
                            std::vector<Run>* runs) const {
  const TimeNs slice_begin = std::max(slice.begin, begin);
  const TimeNs slice_last = std::min(slice.begin + kSlice - 1, last);
  // Bounds of the patch during the slice.
  const double middle_s = ToSeconds((slice_begin - patch.t + slice_last - patch.t) / 2);
  const double half_s = 0.5 * ToSeconds(slice_last - slice_begin);
  const double centre_x = patch.x + middle_s * patch.vx;
  const double centre_y = patch.y + middle_s * patch.vy;
  const double reach_x = patch.radius + half_s * std::abs(patch.vx) + kRoundingPx;
  const double reach_y = patch.radius + half_s * std::abs(patch.vy) + kRoundingPx;
  const std::size_t column_begin = ClampTile(centre_x - reach_x, columns_);
  const std::size_t column_end = ClampTile(centre_x + reach_x, columns_) + 1;
  const std::size_t row_begin = ClampTile(centre_y - reach_y, rows_);
  const std::size_t row_end = ClampTile(centre_y + reach_y, rows_) + 1;
  for (std::size_t row = row_begin; row < row_end; ++row) {
    const auto entries = slice.TileEntries(row * columns_ + column_begin, row * columns_ + column_end);
    if (entries.empty()) continue;
    __builtin_prefetch(entries.data());
    runs->push_back({entries, static_cast<std::int32_t>(slice.begin - patch.t),
                     static_cast<std::int32_t>(slice_begin - slice.begin),
                     static_cast<std::int32_t>(slice_last - slice.begin)});
  }
}

void EventHistory::Gather(const MovingPatch& patch, LocalEvents* local) const {
  if (patch.half_window > kMaxHalfWindow) throw std::length_error("a window of events is too long");
  const TimeNs begin = std::max(patch.t - patch.half_window, oldest_);
  const TimeNs last = patch.t + patch.half_window;
  // All runs are found before the first is read, so that they are on their way into the cache.
  thread_local std::vector<Run> runs;
  runs.clear();
  for (std::size_t i = FirstSliceEndingAfter(begin); i < slices_.size() && slices_[i].begin <= last; ++i) {
    FindRuns(patch, slices_[i], begin, last, &runs);
  }
  std::size_t candidates = 0;
  for (const Run& run : runs) candidates += run.entries.size();
  // The buffer never shrinks, since growth fills the new part with zeros.
  thread_local LocalEvents buffer;
  if (buffer.size() < candidates + 1) buffer.resize(candidates + 1);
  // Plain pointers: the compiler knows that a write of a polarity does not change them.
  float* const xs = buffer.x.data();
  float* const ys = buffer.y.data();
  float* const dts = buffer.dt.data();
  std::int8_t* const polarities = buffer.polarity.data();
  const auto cx = static_cast<float>(patch.x);
  const auto cy = static_cast<float>(patch.y);
  const auto vx = static_cast<float>(patch.vx);
  const auto vy = static_cast<float>(patch.vy);
  const auto radius = static_cast<float>(patch.radius);
  std::size_t count = 0;
  for (const Run& run : runs) {
    // Without a branch to mispredict: every candidate is written, and the next one overwrites it if it is outside.
    for (const Entry& entry : run.entries) {
      const std::int32_t since_begin = entry.t();
      const float dt = 1e-9f * static_cast<float>(run.offset + since_begin);
      const float x = static_cast<float>(entry.x) - cx;
      const float y = static_cast<float>(entry.y) - cy;
      xs[count] = x;
      ys[count] = y;
      dts[count] = dt;
      polarities[count] = entry.polarity();
      const bool is_inside = (since_begin >= run.first) & (since_begin <= run.last) &
                             (std::abs(x - vx * dt) <= radius) & (std::abs(y - vy * dt) <= radius);
      count += is_inside ? 1 : 0;
    }
  }
  local->x.assign(xs, xs + count);
  local->y.assign(ys, ys + count);
  local->dt.assign(dts, dts + count);
  local->polarity.assign(polarities, polarities + count);
}

}  // namespace evo::events
