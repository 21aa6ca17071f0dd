#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace evo::events {

/// Events in a sixteenth of a tile.
struct FlickerCounts {
  static constexpr int kParts = 16;
  std::uint8_t positive[kParts] = {};
  std::uint8_t negative[kParts] = {};
};

/// The spectra of tiles. A tile's signal is its events in samples of time, those of either sign weighted so that their
/// sum is 0: thresholds differ between the signs, and events of both that always come together are no flicker.
class FlickerSpectrum {
 public:
  static constexpr std::size_t kBins = 256;  ///< samples of a signal
  using Row = std::function<const FlickerCounts*(std::size_t bin)>;

  FlickerSpectrum();

  /// Computes the spectra of `tiles`; row(bin) holds the counts of all tiles.
  void Compute(std::vector<std::uint32_t> tiles, const Row& row);

  std::size_t size() const { return tiles_.size(); }
  std::uint32_t tile(std::size_t i) const { return tiles_[i]; }

  /// Ratio of the i-th tile's events.
  float NegativePerPositive(std::size_t i) const { return positive_weight_[i] / negative_weight_[i]; }
  /// Power of the i-th tile at k / kBins of the sample rate over the mean power at the frequencies around,
  /// kFirst <= k < kEnd. Noise has an exponential distribution with mean 1.
  float Significance(std::size_t i, std::size_t k) const;
  float Power(std::size_t i, std::size_t k) const { return power_[k * 2 * pairs_ + i]; }
  /// Where the line at `k` has its maximum.
  double Refine(std::size_t i, std::size_t k) const;

  /// What the parts of a tile have in common at a frequency.
  struct Line {
    float agreement = 0.0F;  ///< of the parts' phases: 1 if all parts have the same, about 0 for noise, in a tile with
                             ///< one hot pixel, and for a pattern that moves through the tile
    float ratio = 0.0F;      ///< amplitude over that of a signal all of whose events flicker
    float events = 0.0F;     ///< this ratio of the tile's events
  };
  Line Inspect(std::size_t i, double k, const Row& row) const;

  // The frequencies around one are kNeighbours on each side, without the line itself.
  static constexpr std::size_t kGap = 2;
  static constexpr std::size_t kNeighbours = 5;
  static constexpr std::size_t kFirst = kGap + kNeighbours + 1;
  static constexpr std::size_t kEnd = kBins / 2 - kGap - kNeighbours;

 private:
  void FindWeights(const Row& row);
  void LoadSignals(const Row& row);
  void Transform();
  void SplitSignals();

  std::array<float, kBins> window_;
  std::vector<std::uint32_t> tiles_;
  std::size_t pairs_ = 0;               // of tiles: one of the two is the real part
  std::vector<float> positive_weight_;  // per tile
  std::vector<float> negative_weight_;
  std::vector<float> events_;  // per tile
  std::vector<float> total_;   // per tile: sum of the signal's absolute values
  std::vector<float> real_;    // [sample or frequency][pair]
  std::vector<float> imaginary_;
  std::vector<float> power_;      // [frequency][tile]
  std::vector<float> power_sum_;  // of the frequencies before
};

}  // namespace evo::events
