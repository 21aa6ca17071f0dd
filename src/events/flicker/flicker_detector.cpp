#include "events/flicker/flicker_detector.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "events/time_bins.hpp"

namespace evo::events {

namespace {

constexpr std::uint32_t kMinEvents = 64;  // of a tile in a window: one in four samples
constexpr std::uint8_t kMaxCount = std::numeric_limits<std::uint8_t>::max();

// A vote. Noise reaches the significance once in 10^6 frequencies.
constexpr float kVoteSignificance = 15.0F;
constexpr float kVoteAgreement = 0.6F;
constexpr float kVoteRatio = 0.1F;
// A tile at a frequency that the votes have confirmed.
constexpr float kActiveSignificance = 8.0F;
constexpr float kActiveAgreement = 0.5F;
constexpr float kActiveRatio = 0.3F;
// Flickering events of a pixel in a period. Fewer are noise, which the tracker bears better than the mean's loss of
// time.
constexpr float kActiveEvents = 0.25F;

constexpr double kStepHz = 0.5;
constexpr float kFade = 0.75F;        // of a score from window to window
constexpr float kMinScore = 10.0F;    // ten tiles at once, or three again and again
constexpr float kFewVotes = 4.0F;     // are enough if a quarter of all tiles with events vote alike
constexpr double kToleranceHz = 1.0;  // the spectrum's resolution is 4 Hz, an estimate's deviation far less

std::size_t StepOf(double frequency_hz) { return static_cast<std::size_t>(std::lround(frequency_hz / kStepHz)); }

}  // namespace

FlickerDetector::FlickerDetector(int width, int height, const FlickerOptions& options) : tiles_(width, height) {
  const auto clamp = [](double k) {
    return static_cast<std::size_t>(
        std::clamp(k, static_cast<double>(FlickerSpectrum::kFirst), static_cast<double>(FlickerSpectrum::kEnd - 1)));
  };
  min_k_ = clamp(std::floor(options.min_frequency_hz * kBinsPerHz));
  max_k_ = clamp(std::ceil(options.max_frequency_hz * kBinsPerHz));
  counts_.resize(FlickerSpectrum::kBins * tiles_.size());
  score_.assign(StepOf(FlickerSpectrum::kEnd / kBinsPerHz) + 3, 0.0F);
}

void FlickerDetector::Add(const EventColumns& block, std::deque<FlickerSegment>* segments) {
  if (block.empty()) return;
  if (!started_) bin_end_ = block.t.front() + kBin;
  started_ = true;
  FlickerCounts* row = RowAt(bin_);
  for (std::size_t i = 0; i < block.size(); ++i) {
    if (block.t[i] >= bin_end_) {
      AdvanceTo(block.t[i], segments);
      row = RowAt(bin_);
    }
    FlickerCounts& counts = row[tiles_.TileOf(block.x[i], block.y[i])];
    const std::size_t part = FlickerTiles::PartOf(block.x[i], block.y[i]);
    std::uint8_t& count = (block.polarity[i] > 0 ? counts.positive : counts.negative)[part];
    if (count < kMaxCount) ++count;
  }
}

void FlickerDetector::AdvanceTo(TimeNs t, std::deque<FlickerSegment>* segments) {
  // After a silence of two windows all counts are zero, and the next bins tell nothing new.
  constexpr std::size_t kSilence = 2 * FlickerSpectrum::kBins;
  for (std::size_t bin = 0; bin < kSilence && t >= bin_end_; ++bin) NextBin(segments);
  if (t >= bin_end_) bin_end_ = BinEndAfter(t, bin_end_, kBin);
}

void FlickerDetector::NextBin(std::deque<FlickerSegment>* segments) {
  ++bin_;
  if (bin_ >= FlickerSpectrum::kBins && bin_ % kHop == 0) {
    last_ = Analyse();
    last_.end = bin_end_ - static_cast<TimeNs>(kHop / 2) * kBin;
    segments->push_back(last_);
  }
  bin_end_ += kBin;
  std::fill_n(RowAt(bin_), tiles_.size(), FlickerCounts{});
}

FlickerSegment FlickerDetector::Last() const {
  FlickerSegment segment = last_;
  segment.end = std::numeric_limits<TimeNs>::max();
  return segment;
}

FlickerSegment FlickerDetector::Analyse() {
  const FlickerSpectrum::Row row = [this](std::size_t bin) { return RowAt(bin_ + bin); };
  spectrum_.Compute(FindBusyTiles(), row);
  UpdateFrequency(FindVotes(row));
  FlickerSegment segment;
  if (frequency_hz_ == 0.0) return segment;
  segment.frequency_hz = frequency_hz_;
  segment.tiles = FindFlickering(row);
  return segment;
}

std::vector<std::uint32_t> FlickerDetector::FindBusyTiles() {
  std::vector<std::uint32_t> events(tiles_.size(), 0);
  for (std::size_t bin = 0; bin < FlickerSpectrum::kBins; ++bin) {
    const FlickerCounts* row = RowAt(bin);
    for (std::size_t i = 0; i < events.size(); ++i) {
      int sum = 0;
      for (int j = 0; j < FlickerCounts::kParts; ++j) sum += row[i].negative[j] + row[i].positive[j];
      events[i] += static_cast<std::uint32_t>(sum);
    }
  }
  std::vector<std::uint32_t> busy;
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (events[i] >= kMinEvents) busy.push_back(static_cast<std::uint32_t>(i));
  }
  return busy;
}

std::vector<FlickerDetector::Vote> FlickerDetector::FindVotes(const FlickerSpectrum::Row& row) const {
  std::vector<Vote> votes;
  for (std::size_t i = 0; i < spectrum_.size(); ++i) {
    std::size_t best = 0;
    for (std::size_t k = min_k_; k <= max_k_; ++k) {
      if (spectrum_.Significance(i, k) < kVoteSignificance) continue;
      if (best == 0 || spectrum_.Power(i, k) > spectrum_.Power(i, best)) best = k;
    }
    if (best == 0) continue;
    const double k = FindFundamental(i, spectrum_.Refine(i, best));
    const FlickerSpectrum::Line line = spectrum_.Inspect(i, k, row);
    if (line.agreement > kVoteAgreement && line.ratio > kVoteRatio) votes.push_back({i, k / kBinsPerHz});
  }
  return votes;
}

/// Where light of full depth nearly goes out, events come in two bursts at each minimum, so that a harmonic may be the
/// strongest line.
double FlickerDetector::FindFundamental(std::size_t i, double k) const {
  for (const int divisor : {4, 3, 2}) {
    const double fundamental = k / divisor;
    const auto nearest = static_cast<std::size_t>(std::lround(fundamental));
    if (nearest < min_k_ || spectrum_.Significance(i, nearest) < kVoteSignificance) continue;
    if (std::abs(spectrum_.Refine(i, nearest) - fundamental) < kToleranceHz * kBinsPerHz) return fundamental;
  }
  return k;
}

void FlickerDetector::UpdateFrequency(const std::vector<Vote>& votes) {
  for (float& score : score_) score *= kFade;
  for (const Vote& vote : votes) score_[StepOf(vote.frequency_hz)] += 1.0F;
  const auto score = [&](std::size_t i) { return score_[i - 1] + score_[i] + score_[i + 1]; };
  std::size_t best = 1;
  for (std::size_t i = 1; i + 1 < score_.size(); ++i) {
    if (score(i) > score(best)) best = i;
  }
  double sum = 0.0;
  int count = 0;
  for (const Vote& vote : votes) {
    if (std::abs(vote.frequency_hz - static_cast<double>(best) * kStepHz) > kToleranceHz) continue;
    sum += vote.frequency_hz;
    ++count;
  }
  const float few = std::max(kFewVotes, 0.25F * static_cast<float>(spectrum_.size()));
  if (count > 0 && (score(best) >= kMinScore || static_cast<float>(count) >= few)) frequency_hz_ = sum / count;
}

std::vector<FlickerTile> FlickerDetector::FindFlickering(const FlickerSpectrum::Row& row) const {
  std::vector<FlickerTile> flickering;
  const double k = frequency_hz_ * kBinsPerHz;
  const auto nearest = static_cast<std::size_t>(std::lround(k));
  const float min_events = kActiveEvents * static_cast<float>(FlickerTiles::kPixels) * static_cast<float>(k);
  for (std::size_t i = 0; i < spectrum_.size(); ++i) {
    if (spectrum_.Significance(i, nearest) < kActiveSignificance) continue;
    const FlickerSpectrum::Line line = spectrum_.Inspect(i, k, row);
    if (line.agreement > kActiveAgreement && line.ratio > kActiveRatio && line.events > min_events) {
      flickering.push_back({spectrum_.tile(i), spectrum_.NegativePerPositive(i)});
    }
  }
  return flickering;
}

}  // namespace evo::events
