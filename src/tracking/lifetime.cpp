#include "evo/tracking/lifetime.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace evo {

namespace {

constexpr int kMostBins = 60;

struct Lifetime {
  int frames = 0;
  TimeNs first = 0;
  TimeNs last = 0;
};

std::unordered_map<std::int64_t, Lifetime> CollectLifetimes(const Tracks& tracks) {
  std::unordered_map<std::int64_t, Lifetime> lifetimes;
  for (const auto& observation : tracks) {
    Lifetime& lifetime = lifetimes[observation.id];
    if (lifetime.frames++ == 0) lifetime.first = observation.t;
    lifetime.last = observation.t;
  }
  return lifetimes;
}

/// Sorts `values`, so that the sums do not depend on the order in which tracks are visited.
LifetimeMoments ComputeMoments(std::vector<double> values) {
  if (values.empty()) return {};
  std::ranges::sort(values);
  const auto n = static_cast<double>(values.size());
  LifetimeMoments moments;
  for (const double value : values) moments.mean += value / n;
  double variance = 0.0;
  for (const double value : values) variance += (value - moments.mean) * (value - moments.mean) / n;
  moments.standard_deviation = std::sqrt(variance);
  const std::size_t middle = values.size() / 2;
  moments.median = values.size() % 2 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
  moments.max = values.back();
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

std::vector<LifetimeBin> ComputeHistogram(const std::vector<double>& frames) {
  if (frames.empty()) return {};
  const int longest = static_cast<int>(std::ranges::max(frames));
  const int width = static_cast<int>(BinWidth(longest - kFewestFrames + 1));
  std::vector<LifetimeBin> histogram;
  for (int low = kFewestFrames; low <= longest; low += width) histogram.push_back({low, low + width, 0});
  for (const double lifetime : frames) {
    ++histogram[static_cast<std::size_t>((static_cast<int>(lifetime) - kFewestFrames) / width)].tracks;
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

std::vector<LifetimeSecondsBin> ComputeSecondsHistogram(const std::vector<TimeNs>& lifetimes, TimeNs interval) {
  if (lifetimes.empty()) return {};
  const TimeNs unit = std::max<TimeNs>(1, interval);
  const TimeNs longest = std::ranges::max(lifetimes);
  const TimeNs width = unit * BinWidth(longest / unit + 1);
  std::vector<LifetimeSecondsBin> histogram;
  for (TimeNs low = 0; low <= longest; low += width) histogram.push_back({ToSeconds(low), ToSeconds(low + width), 0});
  for (const TimeNs lifetime : lifetimes) ++histogram[static_cast<std::size_t>(lifetime / width)].tracks;
  return histogram;
}

}  // namespace

LifetimeStatistics ComputeLifetimes(const Tracks& tracks, std::span<const TimeNs> frame_stamps) {
  LifetimeStatistics statistics;
  const TimeNs interval = MedianInterval(frame_stamps);
  statistics.frames = static_cast<std::int64_t>(frame_stamps.size());
  statistics.frame_interval_s = ToSeconds(interval);
  std::vector<double> frames;
  std::vector<double> seconds;
  std::vector<TimeNs> nanoseconds;
  for (const auto& [id, lifetime] : CollectLifetimes(tracks)) {
    if (lifetime.frames < kFewestFrames) {
      ++statistics.tracks_too_short;
      continue;
    }
    frames.push_back(lifetime.frames);
    nanoseconds.push_back(lifetime.last - lifetime.first);
    seconds.push_back(ToSeconds(nanoseconds.back()));
    if (!frame_stamps.empty() && lifetime.last >= frame_stamps.back()) ++statistics.tracks_cut_short;
  }
  statistics.tracks = static_cast<std::int64_t>(frames.size());
  statistics.histogram = ComputeHistogram(frames);
  statistics.histogram_seconds = ComputeSecondsHistogram(nanoseconds, interval);
  statistics.in_frames = ComputeMoments(std::move(frames));
  statistics.in_seconds = ComputeMoments(std::move(seconds));
  return statistics;
}

}  // namespace evo
