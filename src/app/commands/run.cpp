#include <algorithm>
#include <iostream>
#include <iterator>
#include <memory>

#include "app/commands.hpp"
#include "app/config.hpp"
#include "app/evaluation/trajectory_results.hpp"
#include "app/run/output_folder.hpp"
#include "app/stages/evaluation_stage.hpp"
#include "app/stages/odometry_stage.hpp"
#include "app/stages/tracking_stage.hpp"

namespace evo::app {

namespace {

constexpr const char* kDefaultAlignments = "origin-scale,sim3";

struct RunArguments {
  CommonOptions common;
  RecordingArguments recording;
  std::string ground_truth;
  std::string align;  ///< empty: the default ones that the motion determines
  ResultOptions results;
};

std::vector<std::string> ResultNames(const std::vector<evaluation::Alignment>& alignments) {
  auto results = TrackingResultNames();
  std::ranges::copy(OdometryResultNames(), std::back_inserter(results));
  std::ranges::copy(EvaluationResultNames(alignments), std::back_inserter(results));
  return results;
}

void RemoveEarlierResults(const std::filesystem::path& folder) {
  RemoveTrackingResults(folder);
  RemoveOdometryResults(folder);
  RemoveEvaluationResults(folder);
}

void RunAll(const RunArguments& arguments, const std::vector<std::string>& command_line) {
  const auto alignments = evaluation::ParseAlignments(arguments.align.empty() ? kDefaultAlignments : arguments.align);
  Config config;
  arguments.common.Apply(&config.parameters);
  config.evaluation.skip_degenerate_alignments = arguments.align.empty();
  const std::filesystem::path& out = arguments.results.out;
  CheckRunFolder(out, ResultNames(alignments), arguments.common.force);
  StageRun run(arguments.common, arguments.results, config.parameters, command_line);

  // All inputs are opened before the work, so that a wrong one is reported at once.
  Recording recording = OpenRecording(arguments.recording, config.filters, &run.record);
  const auto truth = OpenGroundTruth(arguments.ground_truth, arguments.common.Source(), recording, &run.record);
  if (truth) RequireOverlap(*truth, recording, FromSeconds(config.evaluation.association.estimate_clock_offset_s));
  // Earlier results go first: this run may fail or have no ground truth.
  if (arguments.common.force) RemoveEarlierResults(out);

  events::Tracks tracks;
  const TrackingOutcome tracking = RunTrackingStage(config.tracker, &recording, &run, &tracks);
  std::cout << FormatTracking(tracking) << report::FormatFeatures(*run.diagnosis.features) << std::flush;
  const odometry::OdometryResult odometry =
      RunOdometryStage(config.odometry, {tracks, out / "tracks.txt"}, recording.camera, &run);
  std::cout << FormatOdometry(odometry) << report::FormatTrajectory(*run.diagnosis.trajectory) << FormatSpeed(run)
            << report::FormatWarnings(run.diagnosis) << std::flush;
  if (truth) {
    RunEvaluationStage(config.evaluation, *truth, {odometry.trajectory, odometry.covariances, tracking.result.frames},
                       alignments, &run);
  }
  run.Finish();
  std::cout << "results    " << out.string() << '\n';
}

}  // namespace

Command AddRunCommand(CLI::App& app) {
  auto arguments = std::make_shared<RunArguments>();
  auto* const parser = app.add_subcommand("run", "Run all stages: events to tracks, trajectory and error report");
  AddRecordingOptions(*parser, arguments->recording);
  parser
      ->add_option("--ground-truth", arguments->ground_truth,
                   "True poses: MVSEC _gt.hdf5, UZH groundtruth.txt or TUM text; default: the file in the sequence's "
                   "folder, if any")
      ->type_name("FILE");
  AddAlignmentOption(*parser, arguments->align);
  parser->get_option("--align")->default_str(kDefaultAlignments);
  AddOutOption(*parser, arguments->results);
  AddPlotOption(*parser, arguments->results);
  AddDrawingOption(*parser, arguments->results);
  AddConfigurationOptions(*parser, arguments->common);
  AddComputeOptions(*parser, arguments->common);
  AddGroundTruthSourceOption(*parser, arguments->common);
  parser->footer(
      "Examples:\n"
      "  evo-run run --events data_samples/street --out out/street\n"
      "  evo-run run --events outdoor_day2_data.hdf5 --calibration camchain-imucam-outdoor_day.yaml "
      "--ground-truth outdoor_day2_gt.hdf5 --from 12 --to 72 --out out/day2\n"
      "  evo-run run --events data_samples/night --config mine.yaml --set tracker.features=200 --out out/night\n"
      "  evo-run run --events outdoor_day2_data.hdf5 --calibration camchain-imucam-outdoor_day.yaml --mask auto "
      "--save-mask bonnet.png --out out/day2_masked");
  return {parser, [arguments](const auto& command_line) { RunAll(*arguments, command_line); }};
}

}  // namespace evo::app
