#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <unordered_map>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/events/tracks.hpp"

namespace evo::evaluation {

/// Observations by tracks that rest: of at least kMinRestFrames frames, their ends less than kRestSpeed apart a second.
struct RestStatistics {
  std::size_t observations = 0;
  double ratio = 0.0;         ///< of the observations by tracks that rest
  double moving_ratio = 0.0;  ///< of the observations by tracks that rest while the scene moves
};

inline constexpr int kMinRestFrames = 15;  ///< jitter hides the speed of shorter tracks
inline constexpr double kRestSpeed = 6.0;  ///< px/s: 1.8 px over kMinRestFrames frames of 20 ms, more than the jitter
inline constexpr double kMovingSpeed = 24.0;  ///< px/s: four times as fast as what rests

/// Collects these statistics of tracks that arrive in parts. The scene moves in a second of the recording if a quarter
/// of its tracks are faster than kMovingSpeed: noise may rest in most of the tracks, and far ones rest on a road. While
/// the camera stands, all tracks may rest.
class RestCounter {
 public:
  /// Adds the next observations, in order of time. A track ends with the first stamp without it.
  void Add(std::span<const events::TrackObservation> observations);
  /// Of all tracks so far.
  RestStatistics Statistics() const;

 private:
  struct Life {
    events::TrackObservation first, last;
    std::int64_t frames = 0;
  };
  /// A second of the recording.
  struct Second {
    std::vector<float> speeds;  // px/s of the tracks that are long enough
    double resting = 0.0;       // observations
  };
  using Seconds = std::map<std::int64_t, Second>;

  static void Count(const Life& life, Seconds* seconds);

  std::unordered_map<std::int64_t, Life> open_;
  Seconds seconds_;  // of the tracks that have ended
  std::size_t observations_ = 0;
};

}  // namespace evo::evaluation
