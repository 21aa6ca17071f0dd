#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/config.hpp"
#include "app/interrupt.hpp"
#include "app/options.hpp"
#include "app/recording.hpp"
#include "app/run_record.hpp"
#include "evo/core/parallel.hpp"
#include "evo/evaluation/lifetime.hpp"
#include "evo/odometry/odometry.hpp"
#include "evo/tracking/track_events.hpp"

namespace evo::app {

/// Where results go and what is drawn.
struct StageOptions {
  std::filesystem::path out;
  bool no_plots = false;
  double draw_every_s = 0.0;  ///< 0: event frames are drawn once, in the middle, unless no_plots
};

/// --out.
void AddStageOptions(CLI::App& command, StageOptions& options);
/// --no-plots and --draw-every, for commands that see the events.
void AddDrawingOptions(CLI::App& command, StageOptions& options);

/// What all stages of one command share.
struct StageContext {
  /// Reads the configuration and makes sure that `results` (names in options.out) and manifest.json can be written; see
  /// CheckOutputFolder. Throws Error.
  StageContext(const CommonOptions& common, StageOptions stage_options, std::vector<std::string> results,
               const std::vector<std::string>& command_line);
  /// manifest.json, the last file that a command writes. Throws Error (kOutput).
  void Finish();

  Config config;
  StageOptions options;
  bool force;
  bool show_progress;
  RunRecord record;
  InterruptGuard guard;
  ThreadPool pool;
};

struct TrackingOutcome {
  tracking::TrackingResult result;
  evaluation::LifetimeStatistics lifetimes;
  std::size_t observations = 0;
};

/// Files that the tracking stage leaves in the output folder.
std::vector<std::string> TrackingResultNames();
/// Removes those files, the plots and the drawings from `folder`, and manifest.json, which tells of them.
void RemoveTrackingResults(const std::filesystem::path& folder);
/// Tracks the recording and writes tracks.txt, lifetime.csv, tables/lifetime.tex, the plots lifetime, lifetime_seconds
/// and live_features and, in images/, what EventDrawing draws. `kept`: where the tracks go, too, if anywhere; they are
/// not in memory otherwise. Throws Error.
TrackingOutcome RunTrackingStage(StageContext* context, Recording* recording, events::Tracks* kept = nullptr);

std::vector<std::string> OdometryResultNames();
void RemoveOdometryResults(const std::filesystem::path& folder);
/// Runs the odometry and writes trajectory.txt, pose_covariance.csv (if there is a final refinement) and map.ply.
/// `source` is the file of the tracks, for messages. Throws
/// Error.
odometry::OdometryResult RunOdometryStage(StageContext* context, const events::Tracks& tracks,
                                          const std::filesystem::path& source, const geometry::Camera& camera);

/// The stages' summaries for people: aligned lines that end with a newline.
std::string FormatTracking(const TrackingOutcome& outcome);
std::string FormatOdometry(const odometry::OdometryResult& result);
/// Seconds of the recording per second of computing, see RealTimeFactor.
std::string FormatSpeed(const report::Manifest& manifest, int threads);

}  // namespace evo::app
