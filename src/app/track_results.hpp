#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "evo/evaluation/lifetime.hpp"
#include "evo/io/track_io.hpp"
#include "evo/report/figures.hpp"

namespace evo::app {

/// What becomes of tracks while the tracker goes on: they are written, counted and, where asked, kept. Without `kept`,
/// memory does not grow with their number but for a count for each frame.
class TrackResults {
 public:
  /// Opens `path`. Throws Error (kOutput).
  TrackResults(std::filesystem::path path, const std::vector<std::string>& comments, events::Tracks* kept);

  /// The next observations; features missing in a frame do not come again. Throws Error (kOutput).
  void Take(events::Tracks observations);
  /// Puts the file into place. Throws Error (kOutput).
  void Commit() { writer_.Commit(); }

  std::size_t observations() const { return observations_; }
  evaluation::LifetimeStatistics Lifetimes(std::span<const TimeNs> frames) const {
    return lifetimes_.Statistics(frames);
  }
  /// In each of the `frames`, ascending.
  std::vector<report::LiveFeatures> Live(std::span<const TimeNs> frames) const;

 private:
  io::TrackWriter writer_;
  events::Tracks* kept_;
  evaluation::LifetimeCounter lifetimes_;
  std::vector<report::LiveFeatures> live_;  // where there are any
  std::size_t observations_ = 0;
};

}  // namespace evo::app
