#include "events/flicker/flicker_comb.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace evo::events {

namespace {

constexpr std::size_t kPixels = FlickerTiles::kPixels;
constexpr float kUnit = 64.0F;             // of levels per threshold
constexpr std::int16_t kMaxBinSum = 1000;  // sixteen thresholds; eight bins of it fit into 16 bits
constexpr float kMaxLogRatio = 2.0F;
// A level that drifts, since a pixel's thresholds are not known well or its refractory period takes events, fades.
constexpr int kFadeShift = 5;  // over 64 bins, eight periods
// Of kPerPeriod times a threshold: the scene's noise must not reach it, and a single threshold must.
constexpr int kEmit = 6;
constexpr float kMinLearningRate = 0.02F;  // over 100 periods: an edge's events change a ratio little
constexpr float kMinLearned = 8.0F;        // periods before a pixel's level is trusted

}  // namespace

FlickerComb::FlickerComb(int width, int height) : tiles_(width, height) {
  const std::size_t pixels = tiles_.size() * kPixels;
  active_.assign(tiles_.size(), 0);
  age_.assign(tiles_.size(), 0);
  ring_.assign(pixels * kPerPeriod, 0);
  for (auto* column : {&present_, &period_sum_, &mean_, &activity_}) column->assign(pixels, 0);
  positive_step_.assign(pixels, static_cast<std::int16_t>(kUnit));
  negative_step_.assign(pixels, static_cast<std::int16_t>(kUnit));
  log_ratio_.assign(pixels, 0.0F);
  learned_.assign(pixels, 0.0F);
}

void FlickerComb::SetActive(TimeNs t, TimeNs period, const std::vector<FlickerTile>& tiles) {
  if (slots_.empty()) bin_end_ = t + period / kPerPeriod;
  if (!tiles.empty()) bin_ = period / kPerPeriod;
  std::vector<std::uint8_t> active(tiles_.size(), 0);
  slots_.clear();
  for (const FlickerTile& tile : tiles) {
    active[tile.tile] = 1;
    slots_.push_back(tile.tile);
    if (active_[tile.tile] != 0) continue;
    const std::size_t first = tile.tile * kPixels;
    for (auto* column : {&present_, &period_sum_, &mean_, &activity_}) std::fill_n(&(*column)[first], kPixels, 0);
    std::fill_n(&ring_[first * kPerPeriod], kPixels * kPerPeriod, 0);
    age_[tile.tile] = 0;
    for (std::size_t p = first; p < first + kPixels; ++p) {
      if (learned_[p] > 0.0F) continue;
      SetLogRatio(p, std::log(tile.negative_per_positive));
    }
  }
  active_ = std::move(active);
}

void FlickerComb::SetLogRatio(std::size_t pixel, float log_ratio) {
  log_ratio_[pixel] = std::clamp(log_ratio, -kMaxLogRatio, kMaxLogRatio);
  const float step = std::exp(0.5F * log_ratio_[pixel]);
  positive_step_[pixel] = static_cast<std::int16_t>(std::lround(kUnit * step));
  negative_step_[pixel] = static_cast<std::int16_t>(std::lround(kUnit / step));
}

void FlickerComb::CloseBin(EventColumns* events) {
  for (const std::uint32_t tile : slots_) {
    const std::size_t first = tile * kPixels;
    const bool any_fires = Integrate(tile);
    // The mean of the first period is the level from which changes count.
    if (age_[tile] <= kPerPeriod) {
      ++age_[tile];
      std::fill_n(&mean_[first], kPixels, 0);
    } else if (any_fires) {
      Emit(tile, events);
    }
    if (phase_ + 1 == kPerPeriod) LearnSteps(tile);
  }
  phase_ = (phase_ + 1) % kPerPeriod;
  bin_end_ += bin_;
}

/// Adds the present bin to the mean of a tile's pixels. Returns whether any of these has an event.
bool FlickerComb::Integrate(std::size_t tile) {
  const std::size_t first = tile * kPixels;
  std::int16_t* __restrict present = &present_[first];
  std::int16_t* __restrict ring = &ring_[(tile * kPerPeriod + static_cast<std::size_t>(phase_)) * kPixels];
  std::int16_t* __restrict sum = &period_sum_[first];
  std::int16_t* __restrict mean = &mean_[first];
  std::int16_t* __restrict activity = &activity_[first];
  std::int16_t* __restrict fires = fires_.data();
  const std::int16_t* __restrict positive_step = &positive_step_[first];
  const std::int16_t* __restrict negative_step = &negative_step_[first];
  std::int16_t any_fires = 0;
  for (std::size_t p = 0; p < kPixels; ++p) {
    const std::int16_t c = std::min(std::max(present[p], static_cast<std::int16_t>(-kMaxBinSum)), kMaxBinSum);
    present[p] = 0;
    const auto s = static_cast<std::int16_t>(sum[p] + c - ring[p]);
    ring[p] = c;
    sum[p] = s;
    activity[p] = static_cast<std::int16_t>(activity[p] + (c < 0 ? -c : c));
    auto m = static_cast<std::int16_t>(mean[p] + s);
    m = static_cast<std::int16_t>(m - (m >> kFadeShift));
    mean[p] = m;
    const auto fire = static_cast<std::int16_t>((m > static_cast<std::int16_t>(kEmit * positive_step[p])) |
                                                (m < static_cast<std::int16_t>(-kEmit * negative_step[p])));
    fires[p] = fire;
    any_fires = static_cast<std::int16_t>(any_fires | fire);
  }
  return any_fires != 0;
}

/// Appends the events of the tile's pixels that have some.
void FlickerComb::Emit(std::size_t tile, EventColumns* events) {
  for (std::size_t i = 0; i < kPixels; i += 4) {
    std::uint64_t four = 0;  // most have none
    std::memcpy(&four, &fires_[i], sizeof four);
    if (four == 0) continue;
    for (std::size_t j = i; j < i + 4; ++j) {
      if (fires_[j] != 0) EmitPixel(tile * kPixels + j, events);
    }
  }
}

void FlickerComb::EmitPixel(std::size_t p, EventColumns* events) {
  if (learned_[p] > 0.0F && learned_[p] < kMinLearned) {
    mean_[p] = 0;
    return;
  }
  // The mean lags by half a period, of whose first bin the middle counts.
  const TimeNs now = bin_end_ - bin_ * (kPerPeriod - 1) / 2;
  while (mean_[p] > kEmit * positive_step_[p] || mean_[p] < -kEmit * negative_step_[p]) {
    const int sign = mean_[p] > 0 ? 1 : -1;
    const int step = sign > 0 ? positive_step_[p] : negative_step_[p];
    const int slope = sign * period_sum_[p];
    const int past_middle = sign * mean_[p] - kPerPeriod / 2 * step;
    const TimeNs since = slope > 0 ? bin_ * past_middle / slope : 0;
    const auto [x, y] = tiles_.PixelAt(p);
    events->push_back(now - std::clamp<TimeNs>(since, 0, kPerPeriod / 2 * bin_), x, y, static_cast<std::int8_t>(sign));
    mean_[p] = static_cast<std::int16_t>(mean_[p] - sign * kPerPeriod * step);
  }
}

void FlickerComb::LearnSteps(std::size_t tile) {
  constexpr int kMinActivity = 2 * static_cast<int>(kUnit);
  for (std::size_t p = tile * kPixels; p < (tile + 1) * kPixels; ++p) {
    const int activity = activity_[p];
    activity_[p] = 0;
    if (activity < kMinActivity) continue;
    const float change = std::clamp(static_cast<float>(period_sum_[p]), -kUnit, kUnit) / static_cast<float>(activity);
    const float rate = std::max(kMinLearningRate, 1.0F / (2.0F + learned_[p]));
    learned_[p] += 1.0F;
    log_ratio_[p] -= 2.0F * rate * change;
    // The exponential costs more than all the rest of a period.
    if (learned_[p] < kMinLearned || static_cast<int>(learned_[p]) % 8 == 0) SetLogRatio(p, log_ratio_[p]);
  }
}

}  // namespace evo::events
