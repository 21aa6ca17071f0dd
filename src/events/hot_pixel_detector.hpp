#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/events/event_columns.hpp"
#include "evo/events/hot_pixels.hpp"

namespace evo::events {

/// Finds hot pixels in a stream of events.
///
/// A moving edge makes several neighbours fire at nearly the same time; a hot pixel fires alone. The rate of a pixel is
/// therefore measured in those bins of 10 ms in which none of its eight neighbours fires. This quiet rate is the noise
/// rate of an ordinary pixel, in a busy scene too, and the full rate of a hot one. A pixel is hot if its quiet rate is
/// - certainly above `min_rate_hz`, and `rate_ratio` times the second largest of its neighbours (one may be hot too),
/// - what it has more than its neighbours in all: a slow edge makes them fire as much, only at other times,
/// - high in several steps of 0.25 s, since a small object that moves is alone for a moment only,
/// - made by events without the order that edges have: several within milliseconds, and, if the edge vibrates, each
///   change taken back by the next one.
/// It stays hot until its quiet rate falls well below `min_rate_hz`.
///
/// Memory is that of the sensor. The decisions depend on the events alone, not on how they are cut into blocks.
class HotPixelDetector {
 public:
  HotPixelDetector(int width, int height, const HotPixelOptions& options);

  /// Pixel y * width + x becomes hot or ordinary for events from `from` on.
  struct Change {
    TimeNs from = 0;
    std::uint32_t pixel = 0;
    bool is_hot = false;
  };

  /// Adds the next events; appends the changes that they show to `changes`, ordered by time.
  void Add(const EventColumns& events, std::vector<Change>* changes);
  /// Judges the last, incomplete step.
  void Finish(std::vector<Change>* changes);
  /// All changes before this stamp are known.
  TimeNs known_until() const { return known_until_; }

 private:
  static constexpr float kMinLivelyEvents = 8.0F;

  /// The last events of a pixel that may become hot.
  struct Watch {
    static constexpr std::size_t kMaxEvents = 128;
    std::array<TimeNs, kMaxEvents> t{};
    std::array<std::int8_t, kMaxEvents> polarity{};
    std::size_t events = 0;  // since the watch began; the last one is at (events - 1) % kMaxEvents

    std::size_t size() const { return std::min(events, kMaxEvents); }
    std::size_t Place(std::size_t i) const { return (events - size() + i) % kMaxEvents; }  // of the i-th oldest
  };

  void Count(const EventColumns& events, std::size_t begin, std::size_t end);
  void EndBin(std::vector<Change>* changes);
  void EndStep(std::vector<Change>* changes);
  /// Adds the step to the sums and marks the pixels to look at.
  void AddStep();
  void Judge(std::size_t cell, std::vector<Change>* changes);
  bool IsHot(std::size_t cell) const;
  /// Whether the events come in bursts of a few milliseconds.
  static bool IsBursty(const Watch& watch);
  /// Whether the polarities are in random order, or all the same.
  static bool IsDisordered(const Watch& watch);
  void SetHot(std::size_t cell, bool is_hot, std::vector<Change>* changes);
  /// Mean over the sensor.
  float MeanQuietRate() const;
  /// Whether a closer look at a pixel is worth it.
  bool IsLively(std::size_t cell) const {
    return lasting_events_[cell] >= kMinLivelyEvents && quiet_events_[cell] >= min_lively_rate_ * quiet_bins_[cell];
  }
  /// Quiet rate in events a bin.
  float QuietRate(std::size_t cell) const { return quiet_events_[cell] / (quiet_bins_[cell] + 1.0F); }

  int width_;
  int height_;
  std::size_t stride_;  // cells a row; one cell of margin on each side saves all tests for borders
  TimeNs look_ahead_;
  float min_rate_;  // events a bin
  float rate_ratio_;
  float min_lively_rate_ = 0.0F;

  bool started_ = false;
  TimeNs bin_end_ = 0;
  int bins_ = 0;           // of this step
  float all_bins_ = 0.0F;  // with the same memory as the sums below
  TimeNs known_until_;

  // One entry a cell.
  std::vector<std::uint8_t> count_;        // events in this bin; the top bit marks a watched pixel
  std::vector<std::uint8_t> counts_for_;   // 0xFF, or 0 where events do not disturb the neighbours' quiet (hot pixels)
  std::vector<std::uint8_t> step_bins_;    // quiet bins in this step
  std::vector<std::uint8_t> step_events_;  // events in them
  std::vector<std::uint8_t> step_all_;     // events in all bins
  std::vector<std::uint8_t> look_at_;
  std::vector<std::uint8_t> is_hot_;  // 0, kHot or kWasHot
  std::vector<float> quiet_bins_;     // these four with an exponential memory
  std::vector<float> quiet_events_;
  std::vector<float> all_events_;
  std::vector<float> lasting_events_;               // at most kMaxStepEvents a step
  std::unordered_map<std::size_t, Watch> watches_;  // looked up by cell, never walked through
  std::vector<std::uint8_t> row_;
};

}  // namespace evo::events
