#include "evo/evaluation/lifetime.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace evo::evaluation {

namespace {

constexpr int kMaxBins = 60;  // that a plot can show

template <typename Value>
using Counted = std::map<Value, std::int64_t>;  // number of tracks of each value

template <typename Value>
std::int64_t Total(const Counted<Value>& values) {
  std::int64_t total = 0;
  for (const auto& [value, tracks] : values) total += tracks;
  return total;
}

/// Order statistic: the value of the track with `rank`, from 0.
template <typename Value>
Value OrderStatistic(const Counted<Value>& values, std::int64_t rank) {
  for (const auto& [value, tracks] : values) {
    rank -= tracks;
    if (rank < 0) return value;
  }
  return {};
}

/// `in_unit` converts a value to the unit of the summary.
template <typename Value, typename InUnit>
LifetimeSummary Summarize(const Counted<Value>& values, const InUnit& in_unit) {
  if (values.empty()) return {};
  const std::int64_t n = Total(values);
  double sum = 0.0;
  for (const auto& [value, tracks] : values) sum += static_cast<double>(tracks) * in_unit(value);
  LifetimeSummary summary;
  summary.mean = sum / static_cast<double>(n);
  double squares = 0.0;
  for (const auto& [value, tracks] : values) {
    const double deviation = in_unit(value) - summary.mean;
    squares += static_cast<double>(tracks) * deviation * deviation;
  }
  summary.standard_deviation = std::sqrt(squares / static_cast<double>(n));
  summary.median = 0.5 * (in_unit(OrderStatistic(values, (n - 1) / 2)) + in_unit(OrderStatistic(values, n / 2)));
  summary.max = in_unit(values.rbegin()->first);
  return summary;
}

/// The smallest of 1, 2, 5, 10, 20, 50, ... that covers `span` with at most kMaxBins bins.
std::int64_t BinWidth(std::int64_t span) {
  for (std::int64_t decade = 1;; decade *= 10) {
    for (const std::int64_t width : {decade, 2 * decade, 5 * decade}) {
      if ((span + width - 1) / width <= kMaxBins) return width;
    }
  }
}

std::vector<LifetimeBin> ComputeHistogram(const Counted<int>& frames) {
  if (frames.empty()) return {};
  const int max_lifetime = frames.rbegin()->first;
  const int width = static_cast<int>(BinWidth(max_lifetime - kMinLifetimeFrames + 1));
  std::vector<LifetimeBin> histogram;
  for (int low = kMinLifetimeFrames; low <= max_lifetime; low += width) histogram.push_back({low, low + width, 0});
  for (const auto& [lifetime, tracks] : frames) {
    histogram[static_cast<std::size_t>((lifetime - kMinLifetimeFrames) / width)].tracks += tracks;
  }
  return histogram;
}

TimeNs MedianInterval(std::span<const TimeNs> stamps) {
  std::vector<TimeNs> intervals;
  for (std::size_t i = 1; i < stamps.size(); ++i) intervals.push_back(stamps[i] - stamps[i - 1]);
  if (intervals.empty()) return 0;
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::ranges::nth_element(intervals, middle);
  return *middle;
}

std::vector<LifetimeSecondsBin> ComputeSecondsHistogram(const Counted<TimeNs>& durations, TimeNs interval) {
  if (durations.empty()) return {};
  const TimeNs unit = std::max<TimeNs>(1, interval);
  const TimeNs max_lifetime = durations.rbegin()->first;
  const TimeNs width = unit * BinWidth(max_lifetime / unit + 1);
  std::vector<LifetimeSecondsBin> histogram;
  for (TimeNs low = 0; low <= max_lifetime; low += width)
    histogram.push_back({ToSeconds(low), ToSeconds(low + width), 0});
  for (const auto& [duration, tracks] : durations)
    histogram[static_cast<std::size_t>(duration / width)].tracks += tracks;
  return histogram;
}

}  // namespace

void LifetimeCounter::Counts::Add(const Lifetime& lifetime) {
  if (lifetime.frames < kMinLifetimeFrames) {
    ++too_short;
    return;
  }
  ++frames[lifetime.frames];
  ++durations[lifetime.last - lifetime.first];
}

void LifetimeCounter::Add(std::span<const events::TrackObservation> observations) {
  for (const auto& observation : observations) {
    Lifetime& lifetime = open_[observation.id];
    if (lifetime.frames++ == 0) lifetime.first = observation.t;
    lifetime.last = observation.t;
  }
}

void LifetimeCounter::EndBefore(TimeNs t) {
  std::erase_if(open_, [&](const auto& track) {
    const bool is_over = track.second.last < t;
    if (is_over) ended_.Add(track.second);
    return is_over;
  });
}

LifetimeStatistics LifetimeCounter::Statistics(std::span<const TimeNs> frame_stamps) const {
  LifetimeStatistics statistics;
  const TimeNs interval = MedianInterval(frame_stamps);
  statistics.frames = static_cast<std::int64_t>(frame_stamps.size());
  statistics.frame_interval_s = ToSeconds(interval);
  Counts counts = ended_;
  for (const auto& [id, lifetime] : open_) {
    counts.Add(lifetime);
    const bool is_censored = !frame_stamps.empty() && lifetime.last >= frame_stamps.back();
    if (is_censored && lifetime.frames >= kMinLifetimeFrames) ++statistics.tracks_censored;
  }
  statistics.tracks = Total(counts.frames);
  statistics.tracks_too_short = counts.too_short;
  statistics.histogram = ComputeHistogram(counts.frames);
  statistics.histogram_seconds = ComputeSecondsHistogram(counts.durations, interval);
  statistics.in_frames = Summarize(counts.frames, [](int frames) { return static_cast<double>(frames); });
  statistics.in_seconds = Summarize(counts.durations, ToSeconds);
  return statistics;
}

LifetimeStatistics ComputeLifetimes(const events::Tracks& tracks, std::span<const TimeNs> frame_stamps) {
  LifetimeCounter counter;
  counter.Add(tracks);
  return counter.Statistics(frame_stamps);
}

}  // namespace evo::evaluation
