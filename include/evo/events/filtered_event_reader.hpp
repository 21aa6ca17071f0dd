#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "evo/events/block_prefetcher.hpp"
#include "evo/events/event_filter_options.hpp"
#include "evo/events/event_reader.hpp"

namespace evo::events {

class FlickerFilter;
class HotPixelDetector;

/// Pixels whose events are left out from the start.
struct IgnoredPixels {
  std::vector<std::uint8_t> masked;  ///< height x width, row-major: not 0 where events are ignored; empty: nowhere
  std::vector<std::uint32_t> hot;    ///< y * width + x of pixels that are known to be hot
};

/// What the filters left out so far.
struct FilterStatistics {
  std::uint64_t events = 0;         ///< of the recording
  std::size_t masked_pixels = 0;    ///< of the mask
  std::uint64_t masked_events = 0;  ///< left out
  std::uint64_t hot_events = 0;     ///< left out
  FlickerStatistics flicker;
};

/// A stream without the events of masked and of hot pixels. The stages, in this order:
/// 1. mask and known hot pixels;
/// 2. flicker of lamps (see FlickerFilter), which replaces events;
/// 3. hot pixels found in the stream itself, some time ahead of the reader, so that they are gone from the first event
///    on (see HotPixelDetector). The blocks in between are held, at most `kMaxHeldEvents` events.
/// The same events arrive in whichever blocks the recording delivers them.
class FilteredEventReader : public EventReader {
 public:
  static constexpr std::size_t kMaxHeldEvents = 8'000'000;  ///< 13 bytes each

  FilteredEventReader(std::unique_ptr<EventReader> reader, int width, int height, const EventFilterOptions& options,
                      const IgnoredPixels& ignored);
  ~FilteredEventReader() override;

  /// As EventReader says; a block is never empty.
  bool Next(EventColumns* block) override;
  TimeNs first_stamp() const override { return reader_->first_stamp(); }
  TimeNs last_stamp() const override;
  double progress() const override { return prefetcher_.progress(); }

  FilterStatistics statistics() const;
  /// The pixels left out as hot, known ones first, then in the order in which they were found.
  const std::vector<HotPixel>& hot_pixels() const { return hot_; }

 private:
  struct Changes;

  /// Reads and examines blocks until all changes within the first held one are known.
  void ReadAhead();
  /// Takes the next events of the recording, replaces them by those that have passed the first stages, maybe none, and
  /// returns false at the end of the recording.
  bool NextExamined(EventColumns* block);
  /// Removes the events of ignored pixels.
  void ApplyMask(EventColumns* block);
  /// Removes the events of pixels that were found hot.
  void ApplyHotPixels(EventColumns* block);
  /// Calls leaves_out(pixel, i) for events i in [begin, end) of `block`, moves those that stay to `kept` and returns
  /// the end of these.
  template <typename Rule>
  std::size_t Compact(EventColumns* block, std::size_t begin, std::size_t end, std::size_t kept, Rule leaves_out) const;
  /// Counts events of a hot pixel at `t`.
  void CountHot(std::size_t pixel, TimeNs t, std::uint64_t events);

  std::unique_ptr<EventReader> reader_;
  std::size_t width_;
  FilterStatistics statistics_;
  bool has_ended_ = false;
  std::vector<std::uint8_t> ignored_;     // by pixel: 0, kMasked or kKnownHot; empty: nothing is ignored
  std::vector<std::uint8_t> is_hot_;      // by pixel: found and not released
  std::size_t hot_pixels_ = 0;            // in is_hot_
  std::vector<std::uint32_t> hot_place_;  // by pixel: place in hot_ plus one
  std::vector<HotPixel> hot_;             // in the order in which they became so
  std::unique_ptr<FlickerFilter> flicker_;
  std::unique_ptr<HotPixelDetector> detector_;
  std::unique_ptr<Changes> changes_;  // not applied yet
  std::deque<EventColumns> held_;
  std::size_t held_events_ = 0;
  std::vector<EventColumns> spare_;  // kept for their memory
  BlockPrefetcher prefetcher_;       // of the recording
};

}  // namespace evo::events
