#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "app/config.hpp"
#include "app/run_record.hpp"
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
  GroundTruthSource source = GroundTruthSource::kLoam;
  EvaluationInterval interval;
};

/// track_quality.csv, track_errors.csv and lifetime.csv.
std::vector<std::string> TrackEvaluationResultNames();

/// Removes those files and the plots from `folder`, and manifest.json, which tells of them.
void RemoveTrackEvaluationResults(const std::filesystem::path& folder);

/// Judges the tracks, writes those files and plots/track_error and plots/lifetime, and returns the summary for people.
/// With `force`, earlier ones are removed first.
/// The lifetimes of asynchronous tracks are those of the frames that the odometry makes of them. Throws Error.
std::string RunTrackEvaluation(const TrackEvaluationArguments& arguments, const TruePoses& poses, const Config& config,
                               const std::filesystem::path& out, bool with_plots, bool force, RunRecord* record);

}  // namespace evo::app
