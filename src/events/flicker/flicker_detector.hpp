#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "events/flicker/flicker_comb.hpp"
#include "events/flicker/flicker_spectrum.hpp"
#include "events/flicker/tiles.hpp"
#include "evo/core/time.hpp"
#include "evo/events/event_columns.hpp"
#include "evo/events/flicker.hpp"

namespace evo::events {

/// Where and how fast light flickers until `end`.
struct FlickerSegment {
  TimeNs end = 0;  ///< exclusive
  double frequency_hz = 0.0;
  std::vector<FlickerTile> tiles;  ///< empty: nothing flickers
};

/// Finds flicker in windows of 256 ms that overlap by half. What a window shows holds for its middle half.
///
/// A tile votes for a frequency if its spectrum has a line there that most of its pixels share with one phase. A
/// pattern that moves through the image, such as a fence, makes lines too, but in few tiles at a time, and not with one
/// phase, and its frequency changes with the camera's speed. So flicker is what many tiles or some tiles again and
/// again vote for.
class FlickerDetector {
 public:
  FlickerDetector(int width, int height, const FlickerOptions& options);

  /// Appends the segments that the events, the next ones of the stream, complete.
  void Add(const EventColumns& block, std::deque<FlickerSegment>* segments);
  /// The segment that lasts to the end of the stream.
  FlickerSegment Last() const;

 private:
  static constexpr TimeNs kBin = 1'000'000;
  static constexpr std::size_t kHop = FlickerSpectrum::kBins / 2;
  static constexpr double kBinsPerHz = 1e-9 * kBin * FlickerSpectrum::kBins;

  /// The best line of a tile.
  struct Vote {
    std::size_t i = 0;  ///< of the spectrum's tile
    double frequency_hz = 0.0;
  };

  /// Closes the bins that end before `t`.
  void AdvanceTo(TimeNs t, std::deque<FlickerSegment>* segments);
  void NextBin(std::deque<FlickerSegment>* segments);
  FlickerSegment Analyse();
  std::vector<std::uint32_t> FindBusyTiles();
  std::vector<Vote> FindVotes(const FlickerSpectrum::Row& row) const;
  double FindFundamental(std::size_t i, double k) const;
  void UpdateFrequency(const std::vector<Vote>& votes);
  std::vector<FlickerTile> FindFlickering(const FlickerSpectrum::Row& row) const;
  FlickerCounts* RowAt(std::size_t bin) { return &counts_[bin % FlickerSpectrum::kBins * tiles_.size()]; }

  FlickerTiles tiles_;
  std::size_t min_k_;
  std::size_t max_k_;
  std::vector<FlickerCounts> counts_;  // ring of rows of tiles
  std::size_t bin_ = 0;                // the present one since the start
  TimeNs bin_end_ = 0;
  bool started_ = false;
  FlickerSpectrum spectrum_;
  std::vector<float> score_;   // of frequencies in steps of kStepHz: votes, fading
  double frequency_hz_ = 0.0;  // of the flicker that was seen last
  FlickerSegment last_;
};

}  // namespace evo::events
