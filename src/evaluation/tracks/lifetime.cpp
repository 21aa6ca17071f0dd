#include "evo/evaluation/lifetime.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace evo::evaluation {

namespace {

constexpr int kMostBins = 60;

template <typename Value>
using Counted = std::map<Value, std::int64_t>;  // how many tracks have each value

template <typename Value>
std::int64_t Total(const Counted<Value>& values) {
  std::int64_t total = 0;
  for (const auto& [value, tracks] : values) total += tracks;
  return total;
}

/// The value of the track with that `rank` from 0 on.
template <typename Value>
Value Ranked(const Counted<Value>& values, std::int64_t rank) {
  for (const auto& [value, tracks] : values) {
    rank -= tracks;
    if (rank < 0) return value;
  }
  return {};
}

/// `in_unit` turns a value into the unit of the moments.
template <typename Value, typename InUnit>
LifetimeMoments ComputeMoments(const Counted<Value>& values, const InUnit& in_unit) {
  if (values.empty()) return {};
  const std::int64_t n = Total(values);
  double sum = 0.0;
  for (const auto& [value, tracks] : values) sum += static_cast<double>(tracks) * in_unit(value);
  LifetimeMoments moments;
  moments.mean = sum / static_cast<double>(n);
  double squares = 0.0;
  for (const auto& [value, tracks] : values) {
    const double away = in_unit(value) - moments.mean;
    squares += static_cast<double>(tracks) * away * away;
  }
  moments.standard_deviation = std::sqrt(squares / static_cast<double>(n));
  moments.median = 0.5 * (in_unit(Ranked(values, (n - 1) / 2)) + in_unit(Ranked(values, n / 2)));
  moments.max = in_unit(values.rbegin()->first);
  return moments;
}

/// The smallest of 1, 2, 5, 10, 20, 50, ... that covers `span` with at most kMostBins bins.
std::int64_t BinWidth(std::int64_t span) {
  for (std::int64_t decade = 1;; decade *= 10) {
    for (const std::int64_t width : {decade, 2 * decade, 5 * decade}) {
      if ((span + width - 1) / width <= kMostBins) return width;
    }
  }
}

std::vector<LifetimeBin> ComputeHistogram(const Counted<int>& frames) {
  if (frames.empty()) return {};
  const int longest = frames.rbegin()->first;
  const int width = static_cast<int>(BinWidth(longest - kFewestFrames + 1));
  std::vector<LifetimeBin> histogram;
  for (int low = kFewestFrames; low <= longest; low += width) histogram.push_back({low, low + width, 0});
  for (const auto& [lifetime, tracks] : frames) {
    histogram[static_cast<std::size_t>((lifetime - kFewestFrames) / width)].tracks += tracks;
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
  const TimeNs longest = durations.rbegin()->first;
  const TimeNs width = unit * BinWidth(longest / unit + 1);
  std::vector<LifetimeSecondsBin> histogram;
  for (TimeNs low = 0; low <= longest; low += width) histogram.push_back({ToSeconds(low), ToSeconds(low + width), 0});
  for (const auto& [duration, tracks] : durations)
    histogram[static_cast<std::size_t>(duration / width)].tracks += tracks;
  return histogram;
}

}  // namespace

void LifetimeCounter::Counts::Add(const Lifetime& lifetime) {
  if (lifetime.frames < kFewestFrames) {
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
    const bool is_cut_short = !frame_stamps.empty() && lifetime.last >= frame_stamps.back();
    if (is_cut_short && lifetime.frames >= kFewestFrames) ++statistics.tracks_cut_short;
  }
  statistics.tracks = Total(counts.frames);
  statistics.tracks_too_short = counts.too_short;
  statistics.histogram = ComputeHistogram(counts.frames);
  statistics.histogram_seconds = ComputeSecondsHistogram(counts.durations, interval);
  statistics.in_frames = ComputeMoments(counts.frames, [](int frames) { return static_cast<double>(frames); });
  statistics.in_seconds = ComputeMoments(counts.durations, ToSeconds);
  return statistics;
}

LifetimeStatistics ComputeLifetimes(const events::Tracks& tracks, std::span<const TimeNs> frame_stamps) {
  LifetimeCounter counter;
  counter.Add(tracks);
  return counter.Statistics(frame_stamps);
}

}  // namespace evo::evaluation
