#include <algorithm>
#include <cmath>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "app/commands.hpp"
#include "app/config.hpp"
#include "app/error_place.hpp"
#include "app/evaluation_results.hpp"
#include "app/interrupt.hpp"
#include "app/options.hpp"
#include "app/output_folder.hpp"
#include "app/run_record.hpp"
#include "app/track_evaluation.hpp"
#include "evo/core/error.hpp"
#include "evo/io/file_kind.hpp"
#include "evo/report/terminal_summary.hpp"

namespace evo::app {

namespace {

constexpr char kExamples[] =
    "Example:\n"
    "  evo-run evaluate --estimate out/trajectory.txt --ground-truth outdoor_day2_gt.hdf5 --align origin-scale,sim3 "
    "--out out/evaluation\n"
    "By evo's rules, relative errors from every pose, only seconds 10 to 40 of the ground truth:\n"
    "  evo-run evaluate --estimate estimate.txt --ground-truth truth.txt --align se3 --association nearest "
    "--rpe 1s,10m --rpe-pairs all --from-stamp 10 --to-stamp 40 --out out/comparison\n"
    "Is the estimate as uncertain as it says?\n"
    "  evo-run evaluate --estimate out/trajectory.txt --covariances out/pose_covariance.csv --ground-truth "
    "outdoor_day2_gt.hdf5 --out out/evaluation\n"
    "KITTI poses, with KITTI's segments of these lengths (m):\n"
    "  evo-run evaluate --estimate 00_estimate.txt --ground-truth 00.txt --align none,sim3 "
    "--set evaluation.kitti_lengths_m=50,100,200 --out out/kitti\n"
    "Feature tracks, by depth maps or triangulation, then by true tracks:\n"
    "  evo-run evaluate --tracks out/tracks.txt --ground-truth outdoor_day2_gt.hdf5 --calibration camchain.yaml "
    "--out out/track_quality\n"
    "  evo-run evaluate --tracks haste_tracks.txt --true-tracks true_tracks.txt --track-thresholds 3,5 "
    "--out out/haste_quality";

struct EvaluateArguments {
  CommonOptions common;
  std::string estimate;
  std::string covariances;
  std::string ground_truth;
  TrackEvaluationArguments tracks;
  std::string align = "origin-scale,sim3";
  std::string association;
  std::optional<double> max_difference_s;
  std::optional<double> time_offset_s;
  std::string rpe;
  std::string rpe_pairs;
  std::string project;
  std::string up;
  std::string forward;
  std::string from;
  std::string to;
  std::string sequence;
  std::string out;
  bool no_plots = false;
};

std::optional<TimeNs> ParseStamp(const std::string& option, const std::string& text) {
  if (text.empty()) return std::nullopt;
  const auto stamp = ParseTime(text);
  if (!stamp) throw Error(ErrorKind::kUsage, option + ": '" + text + "' is not a stamp in seconds");
  return stamp;
}

evaluation::EvaluationInterval ParseInterval(const EvaluateArguments& arguments) {
  const evaluation::EvaluationInterval interval{ParseStamp("--from-stamp", arguments.from),
                                                ParseStamp("--to-stamp", arguments.to)};
  if (interval.from && interval.to && *interval.from >= *interval.to) {
    throw Error(ErrorKind::kUsage, "--from-stamp must come before --to-stamp");
  }
  return interval;
}

void RequireInputs(const EvaluateArguments& arguments) {
  if (arguments.estimate.empty() && arguments.tracks.tracks.empty()) {
    throw Error(ErrorKind::kUsage, "nothing to judge; give --estimate, --tracks or both");
  }
  if (!arguments.tracks.tracks.empty() && arguments.tracks.true_tracks.empty() &&
      arguments.tracks.calibration.empty()) {
    throw Error(ErrorKind::kUsage, "--tracks: give --true-tracks, or --ground-truth and --calibration");
  }
}

/// NaN is in no range.
void SetSeconds(const std::string& name, std::optional<double> given, double lowest, double highest, double* option) {
  if (!given) return;
  if (!(*given >= lowest && *given <= highest)) {
    throw Error(ErrorKind::kUsage, name + " must be a number of seconds from " + std::to_string(std::lround(lowest)) +
                                       " to " + std::to_string(std::lround(highest)));
  }
  *option = *given;
}

/// The options that were given win over the configuration.
void Override(const EvaluateArguments& arguments, evaluation::EvaluationOptions* options) {
  const auto set = [](const auto& given, auto* option) {
    if (!given.empty()) *option = given;
  };
  set(arguments.association, &options->association.association);
  set(arguments.rpe, &options->rpe.deltas);
  set(arguments.rpe_pairs, &options->rpe.pairs);
  set(arguments.project, &options->project);
  set(arguments.up, &options->up);
  set(arguments.forward, &options->forward);
  options->rpe.required = !arguments.rpe.empty();
  SetSeconds("--max-difference", arguments.max_difference_s, 0.0, 1e3, &options->association.max_difference_s);
  SetSeconds("--time-offset", arguments.time_offset_s, -1e9, 1e9, &options->association.estimate_clock_offset_s);
  if (arguments.max_difference_s && options->association.association == "interpolate") {
    throw Error(ErrorKind::kUsage,
                "--max-difference: the association interpolate, which is the default, compares no stamps; choose "
                "--association nearest, unique or nearest-truth");
  }
  evaluation::ParseDeltas(options->rpe.deltas);  // refuses a wrong --rpe before anything is read
}

struct Inputs {
  geometry::Trajectory estimate;
  geometry::Trajectory truth;
};

/// Two files without stamps are compared pose by pose; a file with stamps and one without have nothing in common.
Inputs ReadInputs(const EvaluateArguments& arguments, evaluation::AssociationOptions* association) {
  const bool estimate_is_kitti = io::DetectKind(arguments.estimate) == io::FileKind::kKittiPoses;
  const bool truth_is_kitti = io::DetectKind(arguments.ground_truth) == io::FileKind::kKittiPoses;
  if (estimate_is_kitti != truth_is_kitti) {
    throw Error(ErrorKind::kInput, (estimate_is_kitti ? arguments.estimate : arguments.ground_truth) +
                                       ": its poses have no stamps, those of the other file have; give two files with "
                                       "stamps or two without");
  }
  if (!estimate_is_kitti) {
    return {io::ReadTum(arguments.estimate), io::ReadGroundTruth(arguments.ground_truth, arguments.common.Source())};
  }
  if (!arguments.association.empty() || arguments.max_difference_s || arguments.time_offset_s) {
    throw Error(ErrorKind::kUsage, arguments.estimate +
                                       ": its poses have no stamps and are compared one by one; leave out "
                                       "--association, --max-difference and --time-offset");
  }
  *association = {};
  association->association = "index";
  return {io::ReadKitti(arguments.estimate), io::ReadKitti(arguments.ground_truth)};
}

evaluation::Evaluation EvaluateTrajectory(const EvaluateArguments& arguments,
                                          const std::vector<evaluation::Alignment>& alignments,
                                          const evaluation::EvaluationInterval& interval, const Config& config,
                                          RunRecord* record) {
  record->AddInput("estimate", arguments.estimate);
  evaluation::EvaluationOptions options = config.evaluation;
  const auto [estimate, truth] = record->Time("read", [&] { return ReadInputs(arguments, &options.association); });
  std::vector<geometry::StampedCovariance> covariances;
  if (!arguments.covariances.empty()) {
    record->AddInput("covariances", arguments.covariances);
    covariances = io::ReadPoseCovariances(arguments.covariances);
  }
  auto evaluation = record->Time("evaluate", [&] {
    return NamingPlace(arguments.estimate + " against " + arguments.ground_truth, [&, &e = estimate, &t = truth] {
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
  const bool with_plots = !arguments.no_plots;
  std::string sequence = arguments.sequence;
  if (sequence.empty()) {
    sequence = SequenceName(arguments.ground_truth.empty() ? arguments.tracks.tracks : arguments.ground_truth);
  }
  if (trajectory && arguments.common.force) RemoveEvaluationResults(arguments.out);
  if (tracks && arguments.common.force) RemoveTrackEvaluationResults(arguments.out);
  if (trajectory) WriteEvaluationResults(arguments.out, sequence, *trajectory, with_plots);
  if (tracks) WriteTrackEvaluation(arguments.out, sequence, *tracks, with_plots);
}

void RunEvaluate(const EvaluateArguments& arguments, const std::vector<std::string>& command_line) {
  RequireInputs(arguments);
  Config config;
  arguments.common.Apply(&config.parameters);
  Override(arguments, &config.evaluation);
  const auto alignments = evaluation::ParseAlignments(arguments.align);
  const auto interval = ParseInterval(arguments);
  const bool with_trajectory = !arguments.estimate.empty();
  const bool with_tracks = !arguments.tracks.tracks.empty();

  std::vector<std::string> results{"manifest.json"};
  if (with_trajectory) std::ranges::copy(EvaluationResultNames(alignments), std::back_inserter(results));
  if (with_tracks) std::ranges::copy(TrackEvaluationResultNames(), std::back_inserter(results));
  CheckOutputFolder(arguments.out, results, arguments.common.force);
  const InterruptGuard guard(arguments.out);
  RunRecord record(command_line, config.parameters);
  if (!arguments.ground_truth.empty()) record.AddInput("ground_truth", arguments.ground_truth);
  std::optional<evaluation::Evaluation> trajectory;
  std::optional<TrackEvaluation> tracks;
  if (with_trajectory) trajectory = EvaluateTrajectory(arguments, alignments, interval, config, &record);
  if (with_tracks) {
    const TruePoses poses{arguments.ground_truth, arguments.common.Source(), interval};
    tracks = EvaluateTracks(arguments.tracks, poses, config, &record);
  }
  // Only now, so that a fault of the one does not leave the other's results alone.
  record.Time("write", [&] { WriteResults(arguments, trajectory, tracks); });
  report::WriteManifest(std::filesystem::path(arguments.out) / "manifest.json", record.manifest);
  if (trajectory) std::cout << report::FormatSummary(*trajectory);
  if (tracks) std::cout << FormatTrackEvaluation(*tracks);
}

void AddComparisonOptions(CLI::App& command, EvaluateArguments& arguments) {
  const auto add_choice = [&](const char* name, std::string& value, std::set<std::string> choices, const char* type,
                              const char* help) {
    command.add_option(name, value, help)->check(CLI::IsMember(std::move(choices)).description(""))->type_name(type);
  };
  add_choice(
      "--association", arguments.association, {"interpolate", "nearest", "unique", "nearest-truth"},
      "interpolate|nearest|unique|nearest-truth",
      "how poses find each other: interpolate the truth (default), evo's nearest, TUM's unique (evaluate_ate) or "
      "nearest-truth (evaluate_rpe)");
  command
      .add_option(
          "--max-difference", arguments.max_difference_s,
          "stamps (s) farther apart form no pair; default: 0.01 for nearest, 0.02 for unique, twice the truth's "
          "median interval for nearest-truth; not for interpolate")
      ->type_name("S");
  command
      .add_option("--time-offset", arguments.time_offset_s,
                  "seconds added to the stamps of the estimate and of the tracks; write --time-offset=-0.1")
      ->type_name("S");
  command
      .add_option(
          "--rpe", arguments.rpe,
          "distances of relative errors: frames, s, m, deg or rad, for example 1f,0.5s,10m,5deg,0.1rad; default: "
          "1f,1s,10m")
      ->type_name("LIST");
  add_choice("--rpe-pairs", arguments.rpe_pairs, {"consecutive", "all", "closest"}, "consecutive|all|closest",
             "pairs end to end (default), from every pose, or as TUM's evaluate_rpe takes them");
  add_choice("--project", arguments.project, {"none", "xy", "xz", "yz"}, "none|xy|xz|yz",
             "plane of the truth's world to confine the errors to");
  add_choice("--up", arguments.up, {"auto", "x", "y", "z", "-x", "-y", "-z"}, "auto|[-]x|y|z",
             "axis of the truth's world that points up; write --up=-y");
  add_choice("--forward", arguments.forward, {"travel", "body"}, "travel|body",
             "longitudinal is along the direction of travel in the ground plane (default) or the true camera's axis");
}

}  // namespace

Command AddEvaluateCommand(CLI::App& app) {
  auto arguments = std::make_shared<EvaluateArguments>();
  auto* const parser = app.add_subcommand("evaluate", "Compare a trajectory, or feature tracks, with the ground truth");
  auto* const ground_truth = parser
                                 ->add_option("--ground-truth", arguments->ground_truth,
                                              "MVSEC _gt.hdf5, UZH groundtruth.txt, TUM text or KITTI poses")
                                 ->type_name("FILE");
  parser->add_option("--estimate", arguments->estimate, "estimated trajectory, TUM text or KITTI poses")
      ->type_name("FILE")
      ->needs(ground_truth);
  parser
      ->add_option(
          "--covariances", arguments->covariances,
          "pose_covariance.csv of the estimate: are its errors as large as it says? Fits the scale if the first "
          "alignment does")
      ->type_name("FILE")
      ->needs("--estimate");
  AddTrackEvaluationOptions(*parser, arguments->tracks, ground_truth);
  AddAlignmentOption(*parser, arguments->align);
  AddComparisonOptions(*parser, *arguments);
  parser
      ->add_option("--from-stamp", arguments->from,
                   "judge only from this stamp of the ground truth on, s; KITTI: number of the pose, from 0")
      ->type_name("S");
  parser
      ->add_option("--to-stamp", arguments->to,
                   "judge only up to this stamp, inclusive; true tracks count only that far, too")
      ->type_name("S");
  parser->add_option("--sequence", arguments->sequence, "name in the tables; default: that of the ground truth")
      ->type_name("NAME");
  parser->add_option("--out", arguments->out, "folder for the results")->required()->type_name("DIR");
  parser->add_flag("--no-plots", arguments->no_plots, "write tables only");
  AddConfigurationOptions(*parser, arguments->common);
  AddComputeOptions(*parser, arguments->common);
  AddGroundTruthSourceOption(*parser, arguments->common);
  parser->footer(kExamples);
  return {parser, [arguments](const auto& command_line) { RunEvaluate(*arguments, command_line); }};
}

}  // namespace evo::app
