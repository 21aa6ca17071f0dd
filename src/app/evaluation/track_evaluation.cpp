#include "app/evaluation/track_evaluation.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "app/recording.hpp"
#include "app/run/error_context.hpp"
#include "app/run/output_folder.hpp"
#include "evo/core/error.hpp"
#include "evo/core/output_file.hpp"
#include "evo/io/track_io.hpp"
#include "evo/odometry/resampling.hpp"
#include "evo/report/evaluation_tables.hpp"
#include "evo/report/figures.hpp"
#include "evo/report/latex_tables.hpp"
#include "evo/report/terminal_summary.hpp"
#include "evo/report/track_tables.hpp"

namespace evo::app {

namespace {

struct TrackTruth {
  std::string source;
  std::vector<evaluation::TrueTrack> tracks;
};

TrackTruth ReadTruth(const TrackEvaluationArguments& arguments, const TruePoses& poses, const Config& config,
                     const std::vector<evaluation::FeatureTrack>& tracks) {
  const TimeNs max_gap = FromSeconds(config.evaluation.association.max_interpolation_s);
  if (!arguments.true_tracks.empty()) {
    return {"tracks", evaluation::TruthFromTracks(tracks, io::ReadTracks(arguments.true_tracks), max_gap)};
  }
  const geometry::Camera camera = OpenCamera(arguments.calibration, arguments.sensor);
  const geometry::Trajectory trajectory = io::ReadGroundTruth(poses.path, poses.source);
  const bool with_depth = arguments.truth == "depth" || (arguments.truth == "auto" && io::HasDepthMaps(poses.path));
  if (!with_depth) return {"triangulated", evaluation::TruthFromTriangulation(tracks, trajectory, camera, max_gap)};
  const io::DepthMapReader maps(poses.path);
  return {"depth", evaluation::TruthFromDepth(tracks, trajectory, camera, maps, max_gap, config.track_truth)};
}

/// Reads the tracks of the interval, with stamps in the clock of the truth.
events::Tracks ReadTracks(const std::filesystem::path& path, const evaluation::EvaluationInterval& interval,
                          TimeNs clock_offset) {
  events::Tracks tracks = io::ReadTracks(path);
  for (auto& observation : tracks) observation.t += clock_offset;
  std::erase_if(tracks, [&](const events::TrackObservation& observation) {
    return (interval.from && observation.t < *interval.from) || (interval.to && observation.t > *interval.to);
  });
  if (tracks.empty())
    throw Error(ErrorKind::kNothingToDo,
                path.string() + ": no tracks in the interval; give other --from-stamp and --to-stamp");
  return tracks;
}

/// Whether two features or more share each stamp, which suffices for lifetimes in frames.
bool HaveFrames(const events::Tracks& tracks) { return odometry::AreSynchronous(tracks, 2); }

evaluation::LifetimeStatistics ComputeLifetimes(const events::Tracks& in_frames) {
  std::vector<TimeNs> frames;
  for (const auto& observation : in_frames) {
    if (frames.empty() || frames.back() != observation.t) frames.push_back(observation.t);
  }
  return evaluation::ComputeLifetimes(in_frames, frames);
}

/// A track need not live beyond the interval.
void CutVisibility(std::vector<evaluation::TrueTrack>* truth, std::optional<TimeNs> end) {
  for (auto& track : *truth) {
    if (end && track.visible_until) track.visible_until = std::min(*track.visible_until, *end);
  }
}

}  // namespace

void AddTrackEvaluationOptions(CLI::App& command, TrackEvaluationArguments& arguments, CLI::Option* ground_truth) {
  auto* const tracks = command.add_option(
      "--tracks", arguments.tracks, "Feature tracks to evaluate: rows 'id t x y' or 't,x,y,theta,id', in any order");
  tracks->type_name("FILE");
  auto* const calibration = command
                                .add_option("--calibration", arguments.calibration,
                                            "Calibration of the tracks' camera: Kalibr camchain YAML or UZH calib.txt")
                                ->type_name("FILE")
                                ->needs(tracks)
                                ->needs(ground_truth);
  command
      .add_option("--true-tracks", arguments.true_tracks,
                  "True tracks with the same ids, in place of --ground-truth and --calibration")
      ->type_name("FILE")
      ->needs(tracks)
      ->excludes(calibration);
  AddSensorOption(command, arguments.sensor);
  command
      .add_option("--track-truth", arguments.truth,
                  "Source of the true tracks: depth maps of the ground truth or triangulation; auto takes depth maps "
                  "if there are any")
      ->check(CLI::IsMember({"auto", "depth", "triangulated"}).description(""))
      ->capture_default_str()
      ->type_name("auto|depth|triangulated")
      ->needs(calibration);
  command
      .add_option("--track-thresholds", arguments.thresholds_px,
                  "Largest errors in px of a good track, separated by commas")
      ->delimiter(',')
      ->capture_default_str()
      ->type_name("LIST")
      ->needs(tracks);
}

std::vector<std::string> TrackEvaluationResultNames() {
  return {"track_quality.csv", "track_errors.csv", "lifetime.csv", "tables/lifetime.tex"};
}

void RemoveTrackEvaluationResults(const std::filesystem::path& folder) {
  RemoveResults(folder, R"(manifest\.json|track_quality\.csv|track_errors\.csv|lifetime\.csv)");
  RemoveResults(folder / "tables", R"(lifetime\.tex)");
  RemovePlots(folder, "track_error|lifetime|lifetime_seconds");
}

TrackEvaluation EvaluateTracks(const TrackEvaluationArguments& arguments, const TruePoses& poses, const Config& config,
                               RunRecord* record) {
  record->AddInput("tracks", arguments.tracks);
  if (!arguments.true_tracks.empty()) record->AddInput("true_tracks", arguments.true_tracks);
  if (!arguments.calibration.empty()) record->AddInput("calibration", arguments.calibration);
  const TimeNs offset = FromSeconds(config.evaluation.association.estimate_clock_offset_s);
  const events::Tracks tracks =
      record->Time("read_tracks", [&] { return ReadTracks(arguments.tracks, poses.interval, offset); });
  TrackEvaluation evaluation;
  evaluation.accuracy = record->Time("evaluate_tracks", [&] {
    return WithErrorContext(arguments.tracks, [&] {
      const auto grouped = evaluation::GroupById(tracks);
      TrackTruth truth = ReadTruth(arguments, poses, config, grouped);
      CutVisibility(&truth.tracks, poses.interval.to);
      return evaluation::EvaluateTracks(grouped, truth.tracks, truth.source, arguments.thresholds_px);
    });
  });
  const auto& resampling = config.odometry.resampling;
  if (!HaveFrames(tracks)) evaluation.made_frames_s = resampling.frame_interval_s;
  evaluation.lifetimes = ComputeLifetimes(evaluation.made_frames_s ? odometry::Resample(tracks, resampling) : tracks);
  record->AddCount("tracks", evaluation.accuracy.tracks.size());
  record->AddCount("track_observations", tracks.size());
  record->AddCount("judged_tracks", static_cast<std::size_t>(
                                        evaluation::Count(evaluation.accuracy, evaluation::TrackStatus::kEvaluated)));
  return evaluation;
}

void WriteTrackEvaluation(const std::filesystem::path& folder, const std::string& sequence,
                          const TrackEvaluation& evaluation, bool with_plots) {
  report::WriteTrackQuality(folder / "track_quality.csv", evaluation.accuracy);
  report::WriteTrackErrors(folder / "track_errors.csv", evaluation.accuracy);
  report::WriteLifetimes(folder / "lifetime.csv", evaluation.lifetimes);
  WriteText(folder / "tables" / "lifetime.tex", report::LifetimeTable(sequence, evaluation.lifetimes));
  if (!with_plots) return;
  report::Gnuplot gnuplot(folder / "plots");
  gnuplot.Draw("track_error", report::TrackErrorFigure("track_error", evaluation.accuracy));
  gnuplot.Draw("lifetime", report::LifetimeFigure("lifetime", evaluation.lifetimes));
  gnuplot.Draw("lifetime_seconds", report::LifetimeSecondsFigure("lifetime_seconds", evaluation.lifetimes));
}

std::string FormatTrackEvaluation(const TrackEvaluation& evaluation) {
  const std::string note =
      evaluation.made_frames_s ? fmt::format(", in frames made every {:g} s", *evaluation.made_frames_s) : "";
  return report::FormatTrackAccuracy(evaluation.accuracy) + report::FormatLifetimes(evaluation.lifetimes, note);
}

}  // namespace evo::app
