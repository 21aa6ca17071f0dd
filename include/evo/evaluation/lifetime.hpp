#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <unordered_map>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/events/tracks.hpp"

namespace evo::evaluation {

/// Tracks of fewer frames are too short to count, as in table 2 of D. Zhu's paper.
inline constexpr int kMinLifetimeFrames = 3;

/// Summary of one quantity over the tracks; 0 without tracks.
struct LifetimeSummary {
  double mean = 0.0;
  double standard_deviation = 0.0;  ///< of the population (divided by n)
  double median = 0.0;
  double max = 0.0;
};

/// Number of tracks with a lifetime in [low, high) frames.
struct LifetimeBin {
  int low = 0;
  int high = 0;
  std::int64_t tracks = 0;
};

/// Number of tracks with a lifetime in [low, high) seconds.
struct LifetimeSecondsBin {
  double low = 0.0;
  double high = 0.0;
  std::int64_t tracks = 0;
};

/// Lifetimes of feature tracks.
struct LifetimeStatistics {
  std::int64_t frames = 0;            ///< frames of the recording
  double frame_interval_s = 0.0;      ///< median time between frames; 0 for fewer than two
  std::int64_t tracks = 0;            ///< counted tracks, of at least kMinLifetimeFrames observations
  std::int64_t tracks_too_short = 0;  ///< tracks of fewer observations, not in the numbers below
  std::int64_t tracks_censored = 0;   ///< counted tracks still alive in the last frame (right-censored)
  LifetimeSummary in_frames;          ///< number of observations
  LifetimeSummary in_seconds;         ///< last stamp minus the first
  /// Contiguous bins from kMinLifetimeFrames to past the longest track, of equal widths of 1, 2, 5, 10, 20, ... frames.
  std::vector<LifetimeBin> histogram;
  /// Contiguous bins from 0 to past the longest track, of equal widths of 1, 2, 5, 10, 20, ... frame intervals, so that
  /// each bin holds equally many of the possible lifetimes.
  std::vector<LifetimeSecondsBin> histogram_seconds;
};

/// Collects the lifetimes of tracks that arrive in parts.
class LifetimeCounter {
 public:
  /// Adds the next observations, in order of time.
  void Add(std::span<const events::TrackObservation> observations);
  /// Ends the tracks last observed before `t`, whose ids must not come again. This frees memory.
  void EndBefore(TimeNs t);
  /// Statistics of all tracks so far. `frame_stamps` are those of all frames of the recording, ascending, with or
  /// without tracks; tracks ended by EndBefore do not reach the last one.
  LifetimeStatistics Statistics(std::span<const TimeNs> frame_stamps) const;

 private:
  struct Lifetime {
    int frames = 0;
    TimeNs first = 0;
    TimeNs last = 0;
  };
  /// Number of tracks of each lifetime of at least kMinLifetimeFrames.
  struct Counts {
    std::map<int, std::int64_t> frames;
    std::map<TimeNs, std::int64_t> durations;
    std::int64_t too_short = 0;
    void Add(const Lifetime& lifetime);
  };

  std::unordered_map<std::int64_t, Lifetime> open_;
  Counts ended_;
};

/// Statistics of complete tracks.
LifetimeStatistics ComputeLifetimes(const events::Tracks& tracks, std::span<const TimeNs> frame_stamps);

}  // namespace evo::evaluation
