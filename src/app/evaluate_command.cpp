#include <algorithm>
#include <iostream>
#include <iterator>
#include <memory>

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
#include "evo/report/tables.hpp"

namespace evo::app {

namespace {

struct EvaluateArguments {
  CommonOptions common;
  std::string estimate;
  std::string ground_truth;
  TrackEvaluationArguments tracks;
  std::string align = "origin-scale,sim3";
  std::string association;
  std::string up;
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

EvaluationInterval ParseInterval(const EvaluateArguments& arguments) {
  const EvaluationInterval interval{ParseStamp("--from-stamp", arguments.from), ParseStamp("--to-stamp", arguments.to)};
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

/// Writes the results and returns the summary for people.
std::string EvaluateTrajectory(const EvaluateArguments& arguments, const std::vector<Alignment>& alignments,
                               const EvaluationInterval& interval, const Config& config, RunRecord* record) {
  record->AddInput("estimate", arguments.estimate);
  Trajectory estimate;
  Trajectory truth;
  record->Time("read", [&] {
    estimate = ReadTum(arguments.estimate);
    truth = ReadGroundTruth(arguments.ground_truth, arguments.common.Source());
  });
  const auto evaluation = record->Time("evaluate", [&] {
    return NamingPlace(arguments.estimate + " against " + arguments.ground_truth,
                       [&] { return Evaluate(truth, estimate, alignments, interval, config.evaluation); });
  });
  const std::string sequence = arguments.sequence.empty() ? SequenceName(arguments.ground_truth) : arguments.sequence;
  record->Time("write", [&] { WriteEvaluationResults(arguments.out, sequence, evaluation, !arguments.no_plots); });

  record->AddCount("estimated_poses", estimate.size());
  record->AddCount("true_poses", truth.size());
  record->AddCount("matched_poses", evaluation.alignments.front().errors.size());
  return FormatSummary(evaluation);
}

void RunEvaluate(const EvaluateArguments& arguments, const std::vector<std::string>& command_line) {
  RequireInputs(arguments);
  Config config;
  arguments.common.Apply(&config);
  if (!arguments.association.empty()) config.evaluation.association.association = arguments.association;
  if (!arguments.up.empty()) config.evaluation.up = arguments.up;
  const auto alignments = ParseAlignments(arguments.align);
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
  std::string summary;
  if (with_trajectory) summary += EvaluateTrajectory(arguments, alignments, interval, config, &record);
  if (with_tracks) {
    summary += RunTrackEvaluation(arguments.tracks, {arguments.ground_truth, arguments.common.Source(), interval},
                                  config, arguments.out, !arguments.no_plots, &record);
  }
  WriteManifest(std::filesystem::path(arguments.out) / "manifest.json", record.manifest);
  std::cout << summary;
}

}  // namespace

Command AddEvaluateCommand(CLI::App& app) {
  auto arguments = std::make_shared<EvaluateArguments>();
  auto* const parser = app.add_subcommand("evaluate", "Compare a trajectory, or feature tracks, with the ground truth");
  auto* const ground_truth =
      parser->add_option("--ground-truth", arguments->ground_truth, "MVSEC _gt.hdf5, UZH groundtruth.txt or TUM text")
          ->type_name("FILE");
  parser->add_option("--estimate", arguments->estimate, "estimated trajectory, TUM text")
      ->type_name("FILE")
      ->needs(ground_truth);
  AddTrackEvaluationOptions(*parser, arguments->tracks, ground_truth);
  AddAlignmentOption(*parser, arguments->align);
  parser->add_option("--association", arguments->association, "interpolate the truth (default) or take evo's nearest")
      ->check(CLI::IsMember({"interpolate", "nearest"}).description(""))
      ->type_name("interpolate|nearest");
  parser->add_option("--up", arguments->up, "axis of the truth's world that points up; write --up=-y")
      ->check(CLI::IsMember({"auto", "x", "y", "z", "-x", "-y", "-z"}).description(""))
      ->type_name("auto|[-]x|y|z");
  parser->add_option("--from-stamp", arguments->from, "judge only from this stamp of the ground truth on")
      ->type_name("S");
  parser->add_option("--to-stamp", arguments->to, "judge only up to this stamp")->type_name("S");
  parser->add_option("--sequence", arguments->sequence, "name in the tables; default: that of the ground truth")
      ->type_name("NAME");
  parser->add_option("--out", arguments->out, "folder for the results")->required()->type_name("DIR");
  parser->add_flag("--no-plots", arguments->no_plots, "write tables only");
  AddConfigurationOptions(*parser, arguments->common);
  AddComputeOptions(*parser, arguments->common);
  AddGroundTruthSourceOption(*parser, arguments->common);
  parser->footer(
      "Example:\n  evo-run evaluate --estimate out/trajectory.txt --ground-truth outdoor_day2_gt.hdf5 --align "
      "origin-scale,sim3 --out out/evaluation\n  evo-run evaluate --tracks out/tracks.txt --ground-truth "
      "outdoor_day2_gt.hdf5 --calibration camchain.yaml --out out/track_quality");
  return {parser, [arguments](const auto& command_line) { RunEvaluate(*arguments, command_line); }};
}

}  // namespace evo::app
