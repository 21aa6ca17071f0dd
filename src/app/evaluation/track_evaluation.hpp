#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/config.hpp"
#include "app/run/run_record.hpp"
#include "evo/evaluation/evaluation.hpp"
#include "evo/evaluation/lifetime.hpp"
#include "evo/evaluation/track_accuracy.hpp"
#include "evo/io/trajectory_io.hpp"

namespace evo::app {

/// The arguments for the evaluation of tracks.
struct TrackEvaluationArguments {
  std::string tracks;  ///< empty: no tracks are evaluated
  std::string true_tracks;
  std::string calibration;
  std::string sensor;
  std::string truth = "auto";
  std::vector<double> thresholds_px{1.0, 3.0, 5.0, 10.0};
};

/// --tracks, --true-tracks, --calibration, --sensor, --track-truth and --track-thresholds. `ground_truth` is the option
/// of the true poses.
void AddTrackEvaluationOptions(CLI::App& command, TrackEvaluationArguments& arguments, CLI::Option* ground_truth);

/// The true poses, with an empty path if there are none, and the evaluated interval in their clock.
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
  /// Interval (s) of the frames made from asynchronous tracks, as the odometry makes them; empty for tracks in frames.
  std::optional<double> made_frames_s;
};

/// Reads and evaluates the tracks. Throws Error.
TrackEvaluation EvaluateTracks(const TrackEvaluationArguments& arguments, const TruePoses& poses, const Config& config,
                               RunRecord* record);
/// Removes these files, their plots, and manifest.json, which lists them, from `folder`.
void RemoveTrackEvaluationResults(const std::filesystem::path& folder);
/// Writes these files and plots/track_error, plots/lifetime and plots/lifetime_seconds. Throws Error.
void WriteTrackEvaluation(const std::filesystem::path& folder, const std::string& sequence,
                          const TrackEvaluation& evaluation, bool with_plots);
/// The summary: aligned lines that end with a newline.
std::string FormatTrackEvaluation(const TrackEvaluation& evaluation);

}  // namespace evo::app
