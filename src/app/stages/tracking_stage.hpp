#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/recording.hpp"
#include "app/run/stage_run.hpp"
#include "evo/evaluation/lifetime.hpp"
#include "evo/tracking/track_events.hpp"

namespace evo::app {

struct TrackingOutcome {
  tracking::TrackingResult result;
  evaluation::LifetimeStatistics lifetimes;
  std::size_t observations = 0;
  events::FilterStatistics filters;
  std::size_t hot_pixels = 0;
  std::string auto_mask;  ///< of the recording
};

/// Files of the tracking stage in the output folder.
std::vector<std::string> TrackingResultNames();
/// Removes these files, their plots and drawings, and manifest.json, which lists them.
void RemoveTrackingResults(const std::filesystem::path& folder);

/// Tracks the recording and writes tracks.txt, lifetime.csv, tables/lifetime.tex, the plots lifetime, lifetime_seconds
/// and live_features, and the drawings of EventDrawing in images/. `tracks` receives the tracks; without it they do not
/// stay in memory. Throws Error.
TrackingOutcome RunTrackingStage(const tracking::TrackerOptions& options, Recording* recording, StageRun* run,
                                 events::Tracks* tracks = nullptr);

/// The summary: aligned lines that end with a newline.
std::string FormatTracking(const TrackingOutcome& outcome);

}  // namespace evo::app
