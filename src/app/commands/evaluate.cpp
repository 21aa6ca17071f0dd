#include <algorithm>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>

#include "app/commands.hpp"
#include "app/config.hpp"
#include "app/evaluation/comparison_options.hpp"
#include "app/evaluation/track_evaluation.hpp"
#include "app/evaluation/trajectory_results.hpp"
#include "app/options.hpp"
#include "app/recording.hpp"
#include "app/run/error_context.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/output_folder.hpp"
#include "app/run/run_record.hpp"
#include "evo/core/error.hpp"
#include "evo/io/file_kind.hpp"
#include "evo/io/pose_covariance_io.hpp"
#include "evo/report/terminal_summary.hpp"

namespace evo::app {

namespace {

constexpr char kExamples[] =
    "Examples:\n"
    "A trajectory under two alignments:\n"
    "  evo-run evaluate --estimate out/trajectory.txt --ground-truth outdoor_day2_gt.hdf5 --align origin-scale,sim3 "
    "--out out/evaluation\n"
    "The association of evo, relative errors from every pose, seconds 10 to 40 of the ground truth:\n"
    "  evo-run evaluate --estimate estimate.txt --ground-truth truth.txt --align se3 --association nearest "
    "--rpe 1s,10m --rpe-pairs all --from-stamp 10 --to-stamp 40 --out out/comparison\n"
    "The consistency of the estimated covariances:\n"
    "  evo-run evaluate --estimate out/trajectory.txt --covariances out/pose_covariance.csv --ground-truth "
    "outdoor_day2_gt.hdf5 --out out/evaluation\n"
    "KITTI poses with segments of 50, 100 and 200 m:\n"
    "  evo-run evaluate --estimate 00_estimate.txt --ground-truth 00.txt --align none,sim3 "
    "--set evaluation.kitti_lengths_m=50,100,200 --out out/kitti\n"
    "Feature tracks against depth maps or triangulation, and against true tracks:\n"
    "  evo-run evaluate --tracks out/tracks.txt --ground-truth outdoor_day2_gt.hdf5 --calibration camchain.yaml "
    "--out out/track_quality\n"
    "  evo-run evaluate --tracks haste_tracks.txt --true-tracks true_tracks.txt --track-thresholds 3,5 "
    "--out out/haste_quality";

/// The files of a trajectory to be evaluated.
struct TrajectoryArguments {
  std::string estimate;  ///< empty: no trajectory is evaluated
  std::string covariances;
  std::string ground_truth;
  std::string align = "origin-scale,sim3";
};

struct EvaluateArguments {
  CommonOptions common;
  TrajectoryArguments trajectory;
  TrackEvaluationArguments tracks;
  ComparisonArguments comparison;
  IntervalArguments interval;
  std::string sequence;
  ResultOptions results;
};

void RequireInputs(const EvaluateArguments& arguments) {
  if (arguments.trajectory.estimate.empty() && arguments.tracks.tracks.empty()) {
    throw Error(ErrorKind::kUsage, "evaluate: nothing to evaluate; give --estimate, --tracks or both");
  }
  if (!arguments.tracks.tracks.empty() && arguments.tracks.true_tracks.empty() &&
      arguments.tracks.calibration.empty()) {
    throw Error(ErrorKind::kUsage, "--tracks: give --true-tracks, or --ground-truth and --calibration");
  }
}

struct Trajectories {
  geometry::Trajectory estimate;
  geometry::Trajectory truth;
};

/// Poses without stamps (KITTI) are associated by their number.
Trajectories ReadTrajectories(const EvaluateArguments& arguments, evaluation::AssociationOptions* association) {
  const auto& [estimate, covariances, ground_truth, align] = arguments.trajectory;
  const bool estimate_is_kitti = io::DetectKind(estimate) == io::FileKind::kKittiPoses;
  const bool truth_is_kitti = io::DetectKind(ground_truth) == io::FileKind::kKittiPoses;
  if (estimate_is_kitti != truth_is_kitti) {
    throw Error(ErrorKind::kInput, (estimate_is_kitti ? estimate : ground_truth) +
                                       ": its poses have no stamps, those of the other file have; give two files with "
                                       "stamps or two without");
  }
  if (!estimate_is_kitti) {
    return {io::ReadTum(estimate), io::ReadGroundTruth(ground_truth, arguments.common.Source())};
  }
  if (arguments.comparison.concern_stamps()) {
    throw Error(ErrorKind::kUsage, estimate +
                                       ": its poses have no stamps and are associated by their number; leave out "
                                       "--association, --max-difference and --time-offset");
  }
  *association = {};
  association->association = "index";
  return {io::ReadKitti(estimate), io::ReadKitti(ground_truth)};
}

evaluation::Evaluation EvaluateTrajectory(const EvaluateArguments& arguments,
                                          const std::vector<evaluation::Alignment>& alignments,
                                          const evaluation::EvaluationInterval& interval,
                                          evaluation::EvaluationOptions options, RunRecord* record) {
  const TrajectoryArguments& files = arguments.trajectory;
  record->AddInput("estimate", files.estimate);
  const auto [estimate, truth] =
      record->Time("read", [&] { return ReadTrajectories(arguments, &options.association); });
  std::vector<geometry::StampedCovariance> covariances;
  if (!files.covariances.empty()) {
    record->AddInput("covariances", files.covariances);
    covariances = io::ReadPoseCovariances(files.covariances);
  }
  auto evaluation = record->Time("evaluate", [&] {
    return WithErrorContext(files.estimate + " against " + files.ground_truth, [&, &e = estimate, &t = truth] {
      return evaluation::Evaluate(t, e, alignments, interval, options, covariances);
    });
  });
  record->AddCount("estimated_poses", estimate.size());
  record->AddCount("true_poses", truth.size());
  record->AddCount("matched_poses", evaluation.alignments.front().errors.size());
  return evaluation;
}

void WriteResults(const EvaluateArguments& arguments, const std::optional<evaluation::Evaluation>& trajectory,
                  const std::optional<TrackEvaluation>& tracks) {
  const auto& [out, no_plots, draw_every_s] = arguments.results;
  std::string sequence = arguments.sequence;
  if (sequence.empty()) {
    const std::string& truth = arguments.trajectory.ground_truth;
    sequence = SequenceName(truth.empty() ? arguments.tracks.tracks : truth);
  }
  if (trajectory && arguments.common.force) RemoveEvaluationResults(out);
  if (tracks && arguments.common.force) RemoveTrackEvaluationResults(out);
  if (trajectory) WriteEvaluationResults(out, sequence, *trajectory, !no_plots);
  if (tracks) WriteTrackEvaluation(out, sequence, *tracks, !no_plots);
}

void RunEvaluate(const EvaluateArguments& arguments, const std::vector<std::string>& command_line) {
  RequireInputs(arguments);
  Config config;
  arguments.common.Apply(&config.parameters);
  arguments.comparison.Apply(&config.evaluation);
  const auto alignments = evaluation::ParseAlignments(arguments.trajectory.align);
  const auto interval = arguments.interval.Parse();
  const bool with_trajectory = !arguments.trajectory.estimate.empty();
  const bool with_tracks = !arguments.tracks.tracks.empty();

  std::vector<std::string> results;
  if (with_trajectory) std::ranges::copy(EvaluationResultNames(alignments), std::back_inserter(results));
  if (with_tracks) std::ranges::copy(TrackEvaluationResultNames(), std::back_inserter(results));
  const std::filesystem::path& out = arguments.results.out;
  CheckRunFolder(out, results, arguments.common.force);
  const InterruptGuard guard(out);
  RunRecord record(command_line, config.parameters);
  const std::string& ground_truth = arguments.trajectory.ground_truth;
  if (!ground_truth.empty()) record.AddInput("ground_truth", ground_truth);
  std::optional<evaluation::Evaluation> trajectory;
  std::optional<TrackEvaluation> tracks;
  if (with_trajectory) trajectory = EvaluateTrajectory(arguments, alignments, interval, config.evaluation, &record);
  if (with_tracks) {
    const TruePoses poses{ground_truth, arguments.common.Source(), interval};
    tracks = EvaluateTracks(arguments.tracks, poses, config, &record);
  }
  // Written last, so that a fault of one evaluation leaves no results of the other.
  record.Time("write", [&] { WriteResults(arguments, trajectory, tracks); });
  report::WriteManifest(out / "manifest.json", record.manifest);
  if (trajectory) std::cout << report::FormatSummary(*trajectory);
  if (tracks) std::cout << FormatTrackEvaluation(*tracks);
}

CLI::Option* AddTrajectoryOptions(CLI::App& command, TrajectoryArguments& arguments) {
  auto* const ground_truth =
      command.add_option("--ground-truth", arguments.ground_truth,
                         "True poses: MVSEC _gt.hdf5, UZH groundtruth.txt, TUM text or KITTI poses");
  ground_truth->type_name("FILE");
  command.add_option("--estimate", arguments.estimate, "Estimated trajectory: TUM text or KITTI poses")
      ->type_name("FILE")
      ->needs(ground_truth);
  command
      .add_option("--covariances", arguments.covariances,
                  "pose_covariance.csv of the estimate, whose consistency (NEES) is evaluated; the scale is fitted if "
                  "the first alignment fits it")
      ->type_name("FILE")
      ->needs("--estimate");
  return ground_truth;
}

}  // namespace

Command AddEvaluateCommand(CLI::App& app) {
  auto arguments = std::make_shared<EvaluateArguments>();
  auto* const parser = app.add_subcommand("evaluate", "Compare a trajectory or feature tracks with the ground truth");
  auto* const ground_truth = AddTrajectoryOptions(*parser, arguments->trajectory);
  AddTrackEvaluationOptions(*parser, arguments->tracks, ground_truth);
  AddAlignmentOption(*parser, arguments->trajectory.align);
  AddComparisonOptions(*parser, arguments->comparison);
  AddIntervalOptions(*parser, arguments->interval);
  parser
      ->add_option("--sequence", arguments->sequence,
                   "Name of the sequence in the tables; default: the name of the ground truth")
      ->type_name("NAME");
  AddOutOption(*parser, arguments->results);
  AddPlotOption(*parser, arguments->results);
  AddConfigurationOptions(*parser, arguments->common);
  AddComputeOptions(*parser, arguments->common);
  AddGroundTruthSourceOption(*parser, arguments->common);
  parser->footer(kExamples);
  return {parser, [arguments](const auto& command_line) { RunEvaluate(*arguments, command_line); }};
}

}  // namespace evo::app
