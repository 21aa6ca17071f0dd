#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/config.hpp"
#include "app/recording.hpp"
#include "app/run_record.hpp"
#include "evo/core/parallel.hpp"
#include "evo/odometry/odometry.hpp"
#include "evo/tracking/lifetime.hpp"
#include "evo/tracking/track_events.hpp"

namespace evo::app {

/// Where results go and what is drawn.
struct StageOptions {
  std::filesystem::path out;
  bool no_plots = false;
  double draw_every_s = 0.0;  ///< 0: no images of event frames
};

/// --out and --no-plots.
void AddStageOptions(CLI::App& command, StageOptions& options);
/// --draw-every, for commands that see the events.
void AddDrawingOption(CLI::App& command, StageOptions& options);

/// What all stages of one command share.
struct StageContext {
  const Config& config;
  ThreadPool* pool;
  RunRecord* record;
  StageOptions options;
  bool show_progress = true;
};

struct TrackingOutcome {
  TrackingResult result;
  LifetimeStatistics lifetimes;
};

/// Files that the tracking stage leaves in the output folder.
std::vector<std::string> TrackingResultNames();
/// Tracks the recording and writes tracks.txt, lifetime.csv, plots/lifetime and, every `draw_every_s` seconds, the
/// event frame with its tracks as images/frame_SECONDS.png. Throws Error.
TrackingOutcome RunTrackingStage(const StageContext& context, Recording* recording);

std::vector<std::string> OdometryResultNames();
/// Runs the odometry and writes trajectory.txt and map.ply. `source` is the file of the tracks, for messages. Throws
/// Error.
OdometryResult RunOdometryStage(const StageContext& context, const Tracks& tracks, const std::filesystem::path& source,
                                const Camera& camera);

/// The stages' summaries for people: aligned lines that end with a newline.
std::string FormatTracking(const TrackingOutcome& outcome);
std::string FormatOdometry(const OdometryResult& result);
/// Seconds of the recording per second of computing, see RealTimeFactor.
std::string FormatSpeed(const Manifest& manifest, int threads);

}  // namespace evo::app
