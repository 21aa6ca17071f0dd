#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/config.hpp"
#include "app/run_record.hpp"
#include "evo/evaluation/lifetime.hpp"
#include "evo/evaluation/track_accuracy.hpp"
#include "evo/io/trajectory_io.hpp"

namespace evo::app {

/// What the user says about tracks to be judged.
struct TrackEvaluationArguments {
  std::string tracks;  ///< empty: there are none to judge
  std::string true_tracks;
  std::string calibration;
  std::string sensor;
  std::string truth = "auto";
  std::vector<double> thresholds_px{1.0, 3.0, 5.0, 10.0};
};

/// --tracks, --true-tracks, --calibration, --sensor, --track-truth and --track-thresholds. `ground_truth` is the
/// command's own option for the true poses.
void AddTrackEvaluationOptions(CLI::App& command, TrackEvaluationArguments& arguments, CLI::Option* ground_truth);

/// The poses to judge by, whose path is empty if there are none, and when, in the clock of the truth.
struct TruePoses {
  std::filesystem::path path;
  io::GroundTruthSource source = io::GroundTruthSource::kLoam;
  evaluation::EvaluationInterval interval;
};

/// track_quality.csv, track_errors.csv, lifetime.csv and tables/lifetime.tex.
std::vector<std::string> TrackEvaluationResultNames();

struct TrackEvaluation {
  evaluation::TrackAccuracy accuracy;
  evaluation::LifetimeStatistics lifetimes;
  /// Asynchronous tracks live in frames that are made as the odometry makes them, this far apart; else empty.
  std::optional<double> made_frames_s;
};

/// Reads and judges the tracks. Throws Error.
TrackEvaluation EvaluateTracks(const TrackEvaluationArguments& arguments, const TruePoses& poses, const Config& config,
                               RunRecord* record);
/// Removes those files and the plots from `folder`, and manifest.json, which tells of them.
void RemoveTrackEvaluationResults(const std::filesystem::path& folder);
/// Writes those files and plots/track_error, plots/lifetime and plots/lifetime_seconds. Throws Error.
void WriteTrackEvaluation(const std::filesystem::path& folder, const std::string& sequence,
                          const TrackEvaluation& evaluation, bool with_plots);
/// The summary for people.
std::string FormatTrackEvaluation(const TrackEvaluation& evaluation);

}  // namespace evo::app
