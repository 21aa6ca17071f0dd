#include "events/hot_pixel_detector.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "events/time_bins.hpp"

namespace evo::events {

namespace {

constexpr TimeNs kBin = 10'000'000;  // ns; longer than an edge takes from a pixel to the next, short enough to be quiet
constexpr int kStepBins = 25;        // 0.25 s
constexpr std::uint8_t kWatched = 0x80;
constexpr std::uint8_t kMaxBinEvents = 8;   // 25 such bins fit into a byte
constexpr float kMemory = 15.0F / 16.0F;    // a step's weight against the next one's: sums reach back 4 s
constexpr float kMaxStepEvents = 8.0F;      // of lasting_events_: a burst is not lasting
constexpr float kMinLastingEvents = 24.0F;  // three such steps: an edge leaves no more than a few dozen events at once
constexpr float kMinRecurringEvents = 12.0F;  // of a pixel that was hot before
constexpr float kLivelyRatio = 1.5F;     // to the sensor's mean quiet rate: bounds the work where all pixels are noisy
constexpr float kSigmas = 3.0F;          // by which the counted rate exceeds the minimum
constexpr float kMinExcessRatio = 0.5F;  // of the events that its rate lets expect, beyond what the neighbours have
constexpr std::size_t kMinWatchedEvents = 24;
constexpr double kMaxOnePolarity = 0.05;  // ratio of the rarer one up to which there is but one
// Kuiper's statistic of the order of both polarities: 1.25 +- 0.27 if it is random; at a vibrating edge, which takes
// each change back, the number of events lowers it to 0.2-0.5.
constexpr double kMinKuiper = 0.7;
// Ratio of intervals shorter than a quarter of the mean: 0.22 of random events, 0 of periodic ones, about 0.5 where
// edges make several events each.
constexpr double kMaxShortRatio = 1.0 / 3.0;
constexpr TimeNs kPause = 250'000'000;  // ns; longer ones are no intervals: a pixel may come and go
constexpr float kReleaseRatio = 0.5F;   // of the minimum rate
constexpr std::uint8_t kHot = 1;
constexpr std::uint8_t kWasHot = 2;
constexpr TimeNs kNever = std::numeric_limits<TimeNs>::max();

// The compiler vectorises these loops, since nothing that they write is anything that they read.

/// Sets entries 1 to cells - 2 of `disturbed` to other than 0 where a neighbour has fired. `count` and `counts_for`
/// point to a row between two others.
void MarkDisturbed(const std::uint8_t* __restrict count, const std::uint8_t* __restrict counts_for, std::size_t cells,
                   std::uint8_t* __restrict disturbed) {
  const std::uint8_t* const above = count - cells;
  const std::uint8_t* const above_for = counts_for - cells;
  const std::uint8_t* const below = count + cells;
  const std::uint8_t* const below_for = counts_for + cells;
  const auto column = [&](std::size_t x) { return (above[x] & above_for[x]) | (below[x] & below_for[x]); };
  const auto sides = [&](std::size_t x) { return column(x) | (count[x] & counts_for[x]); };
  for (std::size_t x = 1; x + 1 < cells; ++x) {
    disturbed[x] = static_cast<std::uint8_t>(sides(x - 1) | column(x) | sides(x + 1));
  }
}

struct StepRow {
  std::uint8_t* bins;
  std::uint8_t* events;
  std::uint8_t* all;
};

/// Adds the counts of a row to its step.
void AddBin(const std::uint8_t* __restrict count, const std::uint8_t* __restrict disturbed, std::size_t cells,
            const StepRow& row) {
  std::uint8_t* __restrict const bins = row.bins;
  std::uint8_t* __restrict const events = row.events;
  std::uint8_t* __restrict const all = row.all;
  for (std::size_t x = 1; x + 1 < cells; ++x) {
    const std::uint8_t quiet = disturbed[x] == 0 ? 0xFF : 0;
    const auto own = std::min(static_cast<std::uint8_t>(count[x] & 0x7F), kMaxBinEvents);
    bins[x] = static_cast<std::uint8_t>(bins[x] + (quiet & 1));
    events[x] = static_cast<std::uint8_t>(events[x] + (quiet & own));
    all[x] = static_cast<std::uint8_t>(all[x] + own);
  }
}

/// The sums decay by kMemory and take the step in.
void AddStepTo(const std::uint8_t* __restrict step, std::size_t cells, float max, float* __restrict sum) {
  for (std::size_t i = 0; i < cells; ++i) sum[i] = kMemory * sum[i] + std::min(static_cast<float>(step[i]), max);
}

}  // namespace

void Register(Parameters& parameters, HotPixelOptions& o) {
  parameters.Add("events.hot_pixels.detect", &o.detect,
                 "find pixels that fire by themselves and leave their events out");
  parameters.Add("events.hot_pixels.min_rate_hz", &o.min_rate_hz, 1.0, 1e5,
                 "minimum rate of a hot pixel while its neighbours are quiet (events/s)");
  parameters.Add("events.hot_pixels.rate_ratio", &o.rate_ratio, 1.0, 1000.0,
                 "minimum ratio of this rate to that of its neighbours");
  parameters.Add("events.hot_pixels.look_ahead_s", &o.look_ahead_s, 0.0, 10.0,
                 "time by which hot pixels are sought ahead of the tracker (s)");
}

HotPixelDetector::HotPixelDetector(int width, int height, const HotPixelOptions& options)
    : width_(width),
      height_(height),
      stride_(static_cast<std::size_t>(width) + 2),
      look_ahead_(FromSeconds(options.look_ahead_s)),
      min_rate_(static_cast<float>(options.min_rate_hz * ToSeconds(kBin))),
      rate_ratio_(static_cast<float>(options.rate_ratio)),
      known_until_(std::numeric_limits<TimeNs>::min()) {
  const std::size_t cells = stride_ * (static_cast<std::size_t>(height) + 2);
  for (auto* column : {&count_, &step_bins_, &step_events_, &step_all_, &look_at_, &is_hot_}) column->assign(cells, 0);
  for (auto* column : {&quiet_bins_, &quiet_events_, &all_events_, &lasting_events_}) column->assign(cells, 0.0F);
  counts_for_.assign(cells, 0xFF ^ kWatched);
  row_.assign(stride_, 0);
}

void HotPixelDetector::Add(const EventColumns& events, std::vector<Change>* changes) {
  std::size_t begin = 0;
  while (begin < events.size()) {
    const TimeNs t = events.t[begin];
    if (!started_) {
      bin_end_ = t + kBin;
      started_ = true;
    }
    if (t - bin_end_ > kBin * kStepBins) {
      // A silence says nothing of any pixel: the next step begins with it.
      EndBin(changes);
      if (bins_ > 0) EndStep(changes);
      bin_end_ = BinEndAfter(t, bin_end_, kBin);
    }
    while (t >= bin_end_) EndBin(changes);
    const auto end = std::lower_bound(events.t.begin() + static_cast<std::ptrdiff_t>(begin), events.t.end(), bin_end_);
    const auto end_index = static_cast<std::size_t>(end - events.t.begin());
    Count(events, begin, end_index);
    begin = end_index;
  }
}

void HotPixelDetector::Finish(std::vector<Change>* changes) {
  if (started_) {
    EndBin(changes);
    if (bins_ > 0) EndStep(changes);
  }
  known_until_ = kNever;
}

void HotPixelDetector::Count(const EventColumns& events, std::size_t begin, std::size_t end) {
  std::uint8_t* const count = count_.data() + stride_ + 1;
  for (std::size_t i = begin; i < end; ++i) {
    const std::size_t cell = events.y[i] * stride_ + events.x[i];
    const std::uint8_t value = count[cell];
    // A pixel with more than a hundred events in 10 ms is counted as one with fewer.
    count[cell] = static_cast<std::uint8_t>(value + ((value & 0x7F) < 0x7F ? 1 : 0));
    if (value & kWatched) [[unlikely]] {
      Watch& watch = watches_[cell + stride_ + 1];
      const std::size_t place = watch.events++ % Watch::kMaxEvents;
      watch.t[place] = events.t[i];
      watch.polarity[place] = events.polarity[i];
    }
  }
}

void HotPixelDetector::EndBin(std::vector<Change>* changes) {
  for (std::size_t y = 1; y <= static_cast<std::size_t>(height_); ++y) {
    const std::size_t first = y * stride_;
    MarkDisturbed(&count_[first], &counts_for_[first], stride_, row_.data());
    AddBin(&count_[first], row_.data(), stride_, {&step_bins_[first], &step_events_[first], &step_all_[first]});
  }
  for (std::uint8_t& count : count_) count &= kWatched;
  bin_end_ += kBin;
  if (++bins_ == kStepBins) EndStep(changes);
}

void HotPixelDetector::AddStep() {
  const std::size_t cells = count_.size();
  constexpr float kAny = 255.0F;
  all_bins_ = kMemory * all_bins_ + static_cast<float>(bins_);
  AddStepTo(step_bins_.data(), cells, kAny, quiet_bins_.data());
  AddStepTo(step_events_.data(), cells, kAny, quiet_events_.data());
  AddStepTo(step_all_.data(), cells, kAny, all_events_.data());
  AddStepTo(step_events_.data(), cells, kMaxStepEvents, lasting_events_.data());
  min_lively_rate_ = std::max(min_rate_, kLivelyRatio * MeanQuietRate());
  for (std::size_t i = 0; i < cells; ++i) {
    look_at_[i] = static_cast<std::uint8_t>(IsLively(i) | count_[i] | (is_hot_[i] & kHot));
  }
}

float HotPixelDetector::MeanQuietRate() const {
  double events = 0.0;
  double bins = 0.0;
  for (std::size_t i = 0; i < count_.size(); ++i) {
    events += quiet_events_[i];
    bins += quiet_bins_[i];
  }
  return static_cast<float>(events / (bins + 1.0));
}

void HotPixelDetector::EndStep(std::vector<Change>* changes) {
  AddStep();
  const TimeNs step_end = bin_end_ - kBin;
  known_until_ = step_end - look_ahead_;
  const std::uint8_t* const begin = look_at_.data();
  const std::uint8_t* const end = begin + look_at_.size();
  for (const auto* at = std::find_if(begin, end, [](auto v) { return v != 0; }); at != end;
       at = std::find_if(at + 1, end, [](auto v) { return v != 0; })) {
    Judge(static_cast<std::size_t>(at - begin), changes);
  }
  std::ranges::fill(step_bins_, std::uint8_t{0});
  std::ranges::fill(step_events_, std::uint8_t{0});
  std::ranges::fill(step_all_, std::uint8_t{0});
  bins_ = 0;
}

void HotPixelDetector::Judge(std::size_t cell, std::vector<Change>* changes) {
  const float rate = QuietRate(cell);
  const auto forget = [&] {
    watches_.erase(cell);
    count_[cell] = 0;
  };
  if (is_hot_[cell] & kHot) {
    if (rate < kReleaseRatio * min_rate_) SetHot(cell, false, changes);
    return;
  }
  if (!IsLively(cell)) {
    forget();
    return;
  }
  count_[cell] = kWatched;
  const Watch& watch = watches_[cell];
  if (IsHot(cell) && (is_hot_[cell] == kWasHot || (!IsBursty(watch) && IsDisordered(watch)))) {
    SetHot(cell, true, changes);
    forget();
  }
}

bool HotPixelDetector::IsHot(std::size_t cell) const {
  const float quiet = quiet_events_[cell];
  const float rate = QuietRate(cell);
  const float min_events = min_rate_ * quiet_bins_[cell];
  const float min_lasting = is_hot_[cell] != 0 ? kMinRecurringEvents : kMinLastingEvents;
  if (quiet - kSigmas * std::sqrt(quiet) < min_events) return false;
  if (lasting_events_[cell] < std::max(min_lasting, min_events)) return false;
  std::array<float, 8> rates{};
  std::array<float, 8> events{};
  std::size_t neighbours = 0;
  for (const std::size_t middle : {cell - stride_, cell, cell + stride_}) {
    for (const std::size_t other : {middle - 1, middle, middle + 1}) {
      if (other == cell) continue;
      if ((is_hot_[other] & kHot) == 0) {
        rates[neighbours] = QuietRate(other);
        events[neighbours] = all_events_[other];
      }
      ++neighbours;
    }
  }
  const auto second_largest = [](std::array<float, 8>& values) {
    std::ranges::nth_element(values, values.begin() + 1, std::greater<>());
    return values[1];
  };
  return rate >= rate_ratio_ * second_largest(rates) &&
         all_events_[cell] - second_largest(events) >= kMinExcessRatio * rate * all_bins_;
}

bool HotPixelDetector::IsBursty(const Watch& watch) {
  TimeNs sum = 0;
  int intervals = 0;
  const auto for_each_interval = [&](const auto& visit) {
    for (std::size_t i = 1; i < watch.size(); ++i) {
      const TimeNs interval = watch.t[watch.Place(i)] - watch.t[watch.Place(i - 1)];
      if (interval <= kPause) visit(interval);
    }
  };
  for_each_interval([&](TimeNs interval) {
    sum += interval;
    ++intervals;
  });
  int short_intervals = 0;
  for_each_interval([&](TimeNs interval) { short_intervals += 4 * intervals * interval < sum ? 1 : 0; });
  return short_intervals > kMaxShortRatio * intervals;
}

bool HotPixelDetector::IsDisordered(const Watch& watch) {
  const std::size_t events = watch.size();
  if (events < kMinWatchedEvents) return false;
  const auto positive = static_cast<double>(std::count(watch.polarity.begin(), watch.polarity.end(), std::int8_t{1}));
  const double negative = static_cast<double>(events) - positive;
  if (std::min(positive, negative) <= kMaxOnePolarity * static_cast<double>(events)) return true;
  double sum = 0.0;
  double highest = 0.0;
  double lowest = 0.0;
  for (std::size_t i = 0; i < events; ++i) {
    sum += watch.polarity[watch.Place(i)] > 0 ? 1.0 / positive : -1.0 / negative;
    highest = std::max(highest, sum);
    lowest = std::min(lowest, sum);
  }
  return std::sqrt(positive * negative / static_cast<double>(events)) * (highest - lowest) >= kMinKuiper;
}

void HotPixelDetector::SetHot(std::size_t cell, bool is_hot, std::vector<Change>* changes) {
  is_hot_[cell] = is_hot ? kHot : kWasHot;
  counts_for_[cell] = is_hot ? 0 : 0xFF ^ kWatched;
  const std::size_t x = cell % stride_ - 1;
  const std::size_t y = cell / stride_ - 1;
  changes->push_back({known_until_, static_cast<std::uint32_t>(y * static_cast<std::size_t>(width_) + x), is_hot});
}

}  // namespace evo::events
