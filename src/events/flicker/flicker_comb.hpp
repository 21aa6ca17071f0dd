#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "events/flicker/tiles.hpp"
#include "events/time_bins.hpp"
#include "evo/core/time.hpp"
#include "evo/events/event_columns.hpp"

namespace evo::events {

/// A tile that flickers.
struct FlickerTile {
  std::uint32_t tile = 0;
  float negative_per_positive = 1.0F;  ///< ratio of the events of either sign
};

/// Averages the level of each pixel over the period of the flicker and turns the mean into events.
///
/// The level of a pixel is the sum of its events: thresholds up for positive ones, thresholds down for negative ones.
/// With the level A at the end of each of the kPerPeriod bins of a period, the mean M rises from bin to bin by
/// (A_b - A_(b - period)) / kPerPeriod, the sum of the period's events over kPerPeriod. Flicker and its harmonics are
/// the zeros of this filter. An event is given when M is three quarters of a threshold away from the last event's; its
/// stamp is the time at which M crossed the middle, less the filter's delay. So an edge's events lie evenly about its
/// time.
///
/// The two thresholds differ, and from pixel to pixel. Each pixel's ratio is learned: flicker must not change the
/// level.
class FlickerComb {
 public:
  FlickerComb(int width, int height);

  /// Filters the pixels of these tiles from `t` on, for flicker of this period.
  void SetActive(TimeNs t, TimeNs period, const std::vector<FlickerTile>& tiles);
  bool any_active() const { return !slots_.empty(); }
  bool IsActive(std::size_t tile) const { return active_[tile] != 0; }

  /// Prepares for an event at `t`, not before earlier ones: appends the events of the bins that end until then.
  void AdvanceTo(TimeNs t, EventColumns* events) {
    for (int bin = 0; bin < kFadedPeriods * kPerPeriod && t >= bin_end_; ++bin) CloseBin(events);
    if (t >= bin_end_) bin_end_ = BinEndAfter(t, bin_end_, bin_);
  }
  /// An event of an active tile.
  void Add(std::size_t tile, std::uint16_t x, std::uint16_t y, std::int8_t polarity) {
    const std::size_t pixel = tile * FlickerTiles::kPixels + FlickerTiles::PixelOf(x, y);
    present_[pixel] =
        static_cast<std::int16_t>(present_[pixel] + (polarity > 0 ? positive_step_[pixel] : -negative_step_[pixel]));
  }
  /// No event that comes later has an earlier stamp.
  TimeNs ready() const { return bin_end_ - (1 + kPerPeriod) * bin_; }

 private:
  static constexpr int kPerPeriod = 8;
  static constexpr int kFadedPeriods = 32;  // without events, after which no level changes any more

  void CloseBin(EventColumns* events);
  bool Integrate(std::size_t tile);
  void Emit(std::size_t tile, EventColumns* events);
  void EmitPixel(std::size_t p, EventColumns* events);
  void LearnSteps(std::size_t tile);
  void SetLogRatio(std::size_t pixel, float log_ratio);

  FlickerTiles tiles_;
  TimeNs bin_ = 0;                                           // length
  TimeNs bin_end_ = 0;                                       // of the present bin
  int phase_ = 0;                                            // index of the present bin within the period
  std::vector<std::uint8_t> active_;                         // per tile
  std::vector<std::uint32_t> slots_;                         // active tiles
  std::vector<std::uint8_t> age_;                            // per tile: bins since it became active, saturated
  std::array<std::int16_t, FlickerTiles::kPixels> fires_{};  // of one tile: not 0 for pixels with events
  // Per pixel, tile by tile; in units of 1/64 threshold.
  std::vector<std::int16_t> present_;        // sum of the present bin's events
  std::vector<std::int16_t> ring_;           // [tile][bin of the period][pixel]: of the last period's bins
  std::vector<std::int16_t> period_sum_;     // of ring_
  std::vector<std::int16_t> mean_;           // kPerPeriod M, since the last event
  std::vector<std::int16_t> activity_;       // sum of the present period's absolute values
  std::vector<std::int16_t> positive_step_;  // level of a positive event
  std::vector<std::int16_t> negative_step_;
  std::vector<float> log_ratio_;  // log(positive_step_ / negative_step_)
  std::vector<float> learned_;    // periods that log_ratio_ has seen
};

}  // namespace evo::events
