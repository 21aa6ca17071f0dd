#include "events/flicker/flicker_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace evo::events {

namespace {

constexpr std::size_t kBins = FlickerSpectrum::kBins;
constexpr std::size_t kFrequencies = kBins / 2;
constexpr float kRounding = 1e-5F;  // of sums
constexpr int kParts = FlickerCounts::kParts;

/// The bits of `i < kBins` in reverse order.
std::size_t ReverseBits(std::size_t i) {
  std::size_t reversed = 0;
  for (std::size_t bit = 1; bit < kBins; bit <<= 1) reversed = reversed << 1 | ((i & bit) != 0 ? 1 : 0);
  return reversed;
}

/// Hann's window.
float Window(std::size_t bin) {
  return static_cast<float>(0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * (static_cast<double>(bin) + 0.5) / kBins));
}

/// (a, b) <- (a + w b, a - w b) for each pair of tiles.
void Butterfly(std::complex<float> w, std::size_t n, float* __restrict a_re, float* __restrict a_im,
               float* __restrict b_re, float* __restrict b_im) {
  const float c = w.real();
  const float s = w.imag();
  for (std::size_t i = 0; i < n; ++i) {
    const float re = c * b_re[i] - s * b_im[i];
    const float im = c * b_im[i] + s * b_re[i];
    b_re[i] = a_re[i] - re;
    b_im[i] = a_im[i] - im;
    a_re[i] += re;
    a_im[i] += im;
  }
}

int Sum(const std::uint8_t* parts) {
  int sum = 0;
  for (int j = 0; j < kParts; ++j) sum += parts[j];
  return sum;
}

}  // namespace

FlickerSpectrum::FlickerSpectrum() {
  for (std::size_t bin = 0; bin < kBins; ++bin) window_[bin] = Window(bin);
}

void FlickerSpectrum::Compute(std::vector<std::uint32_t> tiles, const Row& row) {
  tiles_ = std::move(tiles);
  pairs_ = (tiles_.size() + 1) / 2;
  FindWeights(row);
  LoadSignals(row);
  Transform();
  SplitSignals();
}

void FlickerSpectrum::FindWeights(const Row& row) {
  const std::size_t n = tiles_.size();
  std::vector<std::uint32_t> positive(n, 0);
  std::vector<std::uint32_t> negative(n, 0);
  real_.resize(kBins * pairs_);
  imaginary_.resize(kBins * pairs_);
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    const FlickerCounts* counts = row(bin);
    for (std::size_t i = 0; i < n; ++i) {
      positive[i] += static_cast<std::uint32_t>(Sum(counts[tiles_[i]].positive));
      negative[i] += static_cast<std::uint32_t>(Sum(counts[tiles_[i]].negative));
    }
  }
  positive_weight_.resize(n);
  negative_weight_.resize(n);
  total_.resize(n);
  events_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto all = static_cast<float>(std::max(positive[i] + negative[i], 1U));
    positive_weight_[i] = static_cast<float>(negative[i]) / all;
    negative_weight_[i] = static_cast<float>(positive[i]) / all;
    events_[i] = all;
    total_[i] = 2.0F * positive_weight_[i] * static_cast<float>(positive[i]);
  }
}

void FlickerSpectrum::LoadSignals(const Row& row) {
  const std::size_t n = tiles_.size();
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    const FlickerCounts* counts = row(bin);
    const float window = window_[bin];
    float* real = &real_[ReverseBits(bin) * pairs_];
    float* imaginary = &imaginary_[ReverseBits(bin) * pairs_];
    if (n % 2 != 0) imaginary[pairs_ - 1] = 0.0F;
    for (std::size_t i = 0; i < n; ++i) {
      const FlickerCounts& tile = counts[tiles_[i]];
      const float signal = positive_weight_[i] * static_cast<float>(Sum(tile.positive)) -
                           negative_weight_[i] * static_cast<float>(Sum(tile.negative));
      (i % 2 == 0 ? real : imaginary)[i / 2] = window * signal;
    }
  }
}

/// A fast Fourier transform of all pairs.
void FlickerSpectrum::Transform() {
  for (std::size_t size = 1; size < kBins; size *= 2) {
    for (std::size_t k = 0; k < size; ++k) {
      const double angle = -std::numbers::pi * static_cast<double>(k) / static_cast<double>(size);
      const std::complex<float> w(static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)));
      for (std::size_t begin = k; begin < kBins; begin += 2 * size) {
        const std::size_t a = begin * pairs_;
        const std::size_t b = (begin + size) * pairs_;
        Butterfly(w, pairs_, &real_[a], &imaginary_[a], &real_[b], &imaginary_[b]);
      }
    }
  }
}

void FlickerSpectrum::SplitSignals() {
  const std::size_t n = 2 * pairs_;
  power_.assign(n * kFrequencies, 0.0F);
  power_sum_.assign(n * (kFrequencies + 1), 0.0F);
  for (std::size_t k = 1; k < kFrequencies; ++k) {
    const float* re = &real_[k * pairs_];
    const float* im = &imaginary_[k * pairs_];
    const float* mirror_re = &real_[(kBins - k) * pairs_];
    const float* mirror_im = &imaginary_[(kBins - k) * pairs_];
    for (std::size_t i = 0; i < pairs_; ++i) {
      power_[k * n + 2 * i] = 0.25F * (std::norm(std::complex<float>(re[i] + mirror_re[i], im[i] - mirror_im[i])));
      power_[k * n + 2 * i + 1] = 0.25F * (std::norm(std::complex<float>(im[i] + mirror_im[i], mirror_re[i] - re[i])));
    }
    for (std::size_t i = 0; i < n; ++i) power_sum_[(k + 1) * n + i] = power_sum_[k * n + i] + power_[k * n + i];
  }
}

float FlickerSpectrum::Significance(std::size_t i, std::size_t k) const {
  const std::size_t n = 2 * pairs_;
  const auto sum = [&](std::size_t begin, std::size_t end) {
    return power_sum_[end * n + i] - power_sum_[begin * n + i];
  };
  const float around = sum(k - kGap - kNeighbours, k - kGap) + sum(k + kGap + 1, k + kGap + 1 + kNeighbours);
  // Sums of a strong line's power leave rounding errors.
  const float floor = kRounding * power_sum_[kFrequencies * n + i];
  return 2.0F * kNeighbours * power_[k * n + i] / std::max(around, floor + 1e-6F);
}

double FlickerSpectrum::Refine(std::size_t i, std::size_t k) const {
  const auto amplitude = [&](std::size_t j) { return static_cast<double>(std::sqrt(power_[j * 2 * pairs_ + i])); };
  // Of a sinusoid under Hann's window: the larger neighbour is (1 + d) / (2 - d) of the maximum, d away from it.
  const double before = amplitude(k - 1);
  const double after = amplitude(k + 1);
  const double ratio = std::max(before, after) / std::max(amplitude(k), 1e-9);
  const double offset = std::clamp((2.0 * ratio - 1.0) / (1.0 + ratio), 0.0, 0.5);
  return static_cast<double>(k) + (after > before ? offset : -offset);
}

FlickerSpectrum::Line FlickerSpectrum::Inspect(std::size_t i, double k, const Row& row) const {
  float re[kParts] = {};
  float im[kParts] = {};
  const std::complex<double> step = std::polar(1.0, -2.0 * std::numbers::pi * k / kBins);
  std::complex<double> wave = 1.0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    const FlickerCounts& tile = row(bin)[tiles_[i]];
    const auto c = window_[bin] * static_cast<float>(wave.real());
    const auto s = window_[bin] * static_cast<float>(wave.imag());
    wave *= step;
    for (int j = 0; j < kParts; ++j) {
      const float signal = positive_weight_[i] * static_cast<float>(tile.positive[j]) -
                           negative_weight_[i] * static_cast<float>(tile.negative[j]);
      re[j] += c * signal;
      im[j] += s * signal;
    }
  }
  // All pairs of different parts, each weighted by the power of both.
  std::complex<float> sum = 0.0F;
  std::complex<float> weighted_sum = 0.0F;
  float power = 0.0F;
  float square = 0.0F;
  for (int j = 0; j < kParts; ++j) {
    const std::complex<float> part(re[j], im[j]);
    const float norm = std::norm(part);
    sum += part;
    weighted_sum += part * std::sqrt(norm);
    power += norm;
    square += norm * norm;
  }
  Line line;
  line.agreement = (std::norm(weighted_sum) - square) / std::max(power * power - square, 1e-6F);
  line.ratio = std::abs(sum) / std::max(0.5F * total_[i], 1e-6F);
  line.events = line.ratio * events_[i];
  return line;
}

}  // namespace evo::events
