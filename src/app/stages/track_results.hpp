#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "evo/evaluation/lifetime.hpp"
#include "evo/evaluation/track_rest.hpp"
#include "evo/io/track_io.hpp"
#include "evo/report/figures.hpp"

namespace evo::app {

/// Writes and counts the tracks during tracking and appends them to `tracks` if given. Without `tracks`, memory grows
/// only by a count per frame.
class TrackResults {
 public:
  /// Opens `path`. Throws Error (kOutput).
  TrackResults(std::filesystem::path path, const std::vector<std::string>& comments, events::Tracks* tracks);

  /// Adds the observations of the next frames; a track ends with the first frame without it. Throws Error (kOutput).
  void Add(events::Tracks observations);
  /// Completes the file. Throws Error (kOutput).
  void Commit() { writer_.Commit(); }

  std::size_t observations() const { return observations_; }
  evaluation::LifetimeStatistics Lifetimes(std::span<const TimeNs> frames) const {
    return lifetimes_.Statistics(frames);
  }
  evaluation::RestStatistics Rest() const { return rest_.Statistics(); }
  /// The number of tracks in each of the `frames`, which ascend.
  std::vector<report::LiveFeatures> CountLive(std::span<const TimeNs> frames) const;

 private:
  io::TrackWriter writer_;
  events::Tracks* tracks_;
  evaluation::LifetimeCounter lifetimes_;
  evaluation::RestCounter rest_;
  std::vector<report::LiveFeatures> live_;  // of frames with tracks
  std::size_t observations_ = 0;
};

}  // namespace evo::app
