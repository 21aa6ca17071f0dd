#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <unordered_map>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/events/tracks.hpp"

namespace evo::evaluation {

/// Tracks seen in fewer frames than this say nothing about stability and are left out, as in the paper's table 2.
inline constexpr int kFewestFrames = 3;

/// Mean and spread of one quantity over the tracks; all 0 where there are no tracks.
struct LifetimeMoments {
  double mean = 0.0;
  double standard_deviation = 0.0;  ///< of the population (divided by n)
  double median = 0.0;
  double max = 0.0;
};

/// Tracks that live `low` frames or more but fewer than `high`.
struct LifetimeBin {
  int low = 0;
  int high = 0;
  std::int64_t tracks = 0;
};

/// Tracks that live `low` seconds or more but less than `high`.
struct LifetimeSecondsBin {
  double low = 0.0;
  double high = 0.0;
  std::int64_t tracks = 0;
};

/// How long features were followed.
struct LifetimeStatistics {
  std::int64_t frames = 0;            ///< frames of the recording
  double frame_interval_s = 0.0;      ///< median time from frame to frame; 0 where there are not two
  std::int64_t tracks = 0;            ///< tracks that count: kFewestFrames observations or more
  std::int64_t tracks_too_short = 0;  ///< tracks with fewer, left out of everything below
  std::int64_t tracks_cut_short = 0;  ///< counted tracks still alive in the last frame: they would have lived longer
  LifetimeMoments in_frames;          ///< observations of a track
  LifetimeMoments in_seconds;         ///< last stamp of a track minus its first
  /// Without holes from kFewestFrames to past the longest track; equal widths of 1, 2, 5, 10, 20, ... frames.
  std::vector<LifetimeBin> histogram;
  /// Without holes from 0 to past the longest track; equal widths of 1, 2, 5, 10, 20, ... frame intervals, so that all
  /// bins hold equally many of the lifetimes that there can be.
  std::vector<LifetimeSecondsBin> histogram_seconds;
};

/// Collects the lifetimes of tracks that come part by part.
class LifetimeCounter {
 public:
  /// The next observations, in order of time.
  void Add(std::span<const events::TrackObservation> observations);
  /// Takes the tracks last seen before `t` for over: their ids will not come again. That frees memory.
  void EndBefore(TimeNs t);
  /// Of all tracks so far. `frame_stamps` are those of all frames of the recording, ascending, those without any track
  /// included; tracks ended by EndBefore do not reach the last one.
  LifetimeStatistics Statistics(std::span<const TimeNs> frame_stamps) const;

 private:
  struct Lifetime {
    int frames = 0;
    TimeNs first = 0;
    TimeNs last = 0;
  };
  /// Of kFewestFrames or more: how many tracks have each lifetime.
  struct Counts {
    std::map<int, std::int64_t> frames;
    std::map<TimeNs, std::int64_t> durations;
    std::int64_t too_short = 0;
    void Add(const Lifetime& lifetime);
  };

  std::unordered_map<std::int64_t, Lifetime> open_;
  Counts ended_;
};

/// Of all in one call.
LifetimeStatistics ComputeLifetimes(const events::Tracks& tracks, std::span<const TimeNs> frame_stamps);

}  // namespace evo::evaluation
