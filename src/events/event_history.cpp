#include "evo/events/event_history.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

namespace evo {

namespace {

constexpr int kTilePx = EventHistory::kTilePx;

std::size_t ClampTile(double px, std::size_t tiles) {
  const double tile = std::floor(px / kTilePx);
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
      rows_(static_cast<std::size_t>((height + kTilePx - 1) / kTilePx)),
      tiles_(columns_ * rows_) {}

std::vector<EventHistory::Entry>::const_iterator EventHistory::Tile::NotBefore(
    TimeNs t, std::vector<Entry>::const_iterator from) const {
  return std::lower_bound(from, entries.end(), t, [](const Entry& entry, TimeNs at) { return entry.After(at) < 0; });
}

std::span<const EventHistory::Entry> EventHistory::Between(std::size_t tile, TimeNs begin, TimeNs end) const {
  const Tile& in = tiles_[tile];
  const auto held = in.entries.begin() + static_cast<std::ptrdiff_t>(in.dropped);
  // Of instants beyond those held the lower half says nothing.
  const auto first = in.NotBefore(std::clamp(begin, oldest_, newest_ + 1), held);
  return {first, in.NotBefore(std::clamp(end, oldest_, newest_ + 1), first)};
}

void EventHistory::Append(const EventColumns& events, std::size_t begin, std::size_t end) {
  if (begin == end) return;
  if (empty_) oldest_ = events.t[begin];
  empty_ = false;
  newest_ = std::max(oldest_, events.t[end - 1]);
  if (newest_ - oldest_ >= kLongest) throw std::length_error("too long a history: nothing was dropped");
  for (std::size_t i = begin; i < end; ++i) {
    const unsigned x = events.x[i];
    const unsigned y = events.y[i];
    tiles_[(y / kTilePx) * columns_ + x / kTilePx].entries.push_back(
        {static_cast<std::uint32_t>(events.t[i]), static_cast<std::uint8_t>(x % kTilePx),
         static_cast<std::uint8_t>(y % kTilePx), events.polarity[i]});
  }
}

void EventHistory::DropBefore(TimeNs t) {
  if (empty_ || t <= oldest_) return;
  const TimeNs kept = std::min(t, newest_ + 1);
  for (Tile& tile : tiles_) {
    const auto held = tile.entries.begin() + static_cast<std::ptrdiff_t>(tile.dropped);
    tile.dropped = static_cast<std::size_t>(tile.NotBefore(kept, held) - tile.entries.begin());
    // Seldom enough that moving the rest to the front costs nothing.
    if (tile.dropped <= tile.entries.size() / 2) continue;
    tile.entries.erase(tile.entries.begin(), tile.entries.begin() + static_cast<std::ptrdiff_t>(tile.dropped));
    tile.dropped = 0;
  }
  oldest_ = t;
  newest_ = std::max(oldest_, newest_);
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
  const double reach = ToSeconds(patch.half_window);
  const double reach_x = patch.radius + std::abs(patch.vx) * reach;
  const double reach_y = patch.radius + std::abs(patch.vy) * reach;
  const std::size_t column_begin = ClampTile(patch.x - reach_x, columns_);
  const std::size_t column_end = ClampTile(patch.x + reach_x, columns_) + 1;
  const std::size_t row_begin = ClampTile(patch.y - reach_y, rows_);
  const std::size_t row_end = ClampTile(patch.y + reach_y, rows_) + 1;
  const auto cx = static_cast<float>(patch.x);
  const auto cy = static_cast<float>(patch.y);
  const auto vx = static_cast<float>(patch.vx);
  const auto vy = static_cast<float>(patch.vy);
  const auto radius = static_cast<float>(patch.radius);
  const TimeNs patch_t = patch.t;

  std::size_t count = 0;
  for (std::size_t row = row_begin; row < row_end; ++row) {
    for (std::size_t column = column_begin; column < column_end; ++column) {
      const auto entries =
          Between(row * columns_ + column, patch.t - patch.half_window, patch.t + patch.half_window + 1);
      const std::size_t most = count + entries.size();
      if (most > local->size()) local->resize(2 * most);
      // Plain pointers, which a write of a polarity cannot change.
      float* const xs = local->x.data();
      float* const ys = local->y.data();
      float* const dts = local->dt.data();
      std::int8_t* const polarities = local->polarity.data();
      const int left = static_cast<int>(column) * kTilePx;
      const int top = static_cast<int>(row) * kTilePx;
      // Every event is written, but stays only if the next one does not overwrite it: no branch to mispredict.
      for (const Entry& entry : entries) {
        const float dt = 1e-9f * static_cast<float>(entry.After(patch_t));
        const float x = static_cast<float>(left + entry.x) - cx;
        const float y = static_cast<float>(top + entry.y) - cy;
        xs[count] = x;
        ys[count] = y;
        dts[count] = dt;
        polarities[count] = entry.polarity;
        const bool is_inside = (std::abs(x - vx * dt) <= radius) & (std::abs(y - vy * dt) <= radius);
        count += is_inside ? 1 : 0;
      }
    }
  }
  local->resize(count);
}

}  // namespace evo
