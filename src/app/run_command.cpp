#include <spdlog/spdlog.h>

#include <iostream>
#include <memory>
#include <span>

#include "app/commands.hpp"
#include "app/evaluation_results.hpp"
#include "app/interrupt.hpp"
#include "app/options.hpp"
#include "app/output_folder.hpp"
#include "app/stages.hpp"
#include "evo/core/error.hpp"
#include "evo/report/tables.hpp"

namespace evo::app {

namespace {

constexpr const char* kUsualAlignments = "origin-scale,sim3";

struct RunArguments {
  CommonOptions common;
  RecordingArguments recording;
  std::string ground_truth;
  std::string align;  ///< empty: the usual ones, as far as the motion determines them
  StageOptions stage;
};

std::optional<Trajectory> OpenGroundTruth(const RunArguments& arguments, const Recording& recording,
                                          RunRecord* record) {
  std::filesystem::path path = arguments.ground_truth;
  if (path.empty() && recording.ground_truth) path = *recording.ground_truth;
  if (path.empty()) return std::nullopt;
  Trajectory truth = ReadGroundTruth(path, arguments.common.Source());
  record->AddInput("ground_truth", path);
  return truth;
}

/// Drops the alignments that these trajectories do not determine: a straight line, say, leaves sim3's roll open.
void KeepDetermined(const Trajectory& truth, const Trajectory& estimate, const EvaluationInterval& interval,
                    const EvaluationOptions& options, std::vector<Alignment>* alignments) {
  std::erase_if(*alignments, [&](const Alignment& alignment) {
    try {
      Evaluate(truth, estimate, std::span(&alignment, 1), interval, options);
      return false;
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::kDegenerateAlignment) throw;
      spdlog::warn("left out of the report: {}", error.what());
      return true;
    }
  });
}

void Judge(const StageContext& context, const Trajectory& truth, const Trajectory& estimate,
           const std::vector<TimeNs>& frames, std::vector<Alignment> alignments, bool only_determined) {
  // The truth of the whole interval counts: an estimate that covers a part of it must not look complete.
  const EvaluationInterval interval{frames.front(), frames.back()};
  const EvaluationOptions& options = context.config.evaluation;
  if (only_determined) KeepDetermined(truth, estimate, interval, options, &alignments);
  if (alignments.empty()) return;
  const Evaluation evaluation =
      context.record->Time("evaluate", [&] { return Evaluate(truth, estimate, alignments, interval, options); });
  const auto& ground_truth = context.record->manifest.inputs.back().path;
  context.record->Time("write_evaluation", [&] {
    WriteEvaluationResults(context.options.out, SequenceName(ground_truth), evaluation, !context.options.no_plots);
  });
  std::cout << FormatSummary(evaluation);
}

void RunAll(const RunArguments& arguments, const std::vector<std::string>& command_line) {
  Config config;
  arguments.common.Apply(&config);
  const auto alignments = ParseAlignments(arguments.align.empty() ? kUsualAlignments : arguments.align);
  RunRecord record(command_line, config.parameters);
  // Every input is opened before any work, so that a wrong one is reported at once.
  Recording recording = OpenRecording(arguments.recording, &record);
  const auto truth = OpenGroundTruth(arguments, recording, &record);

  auto results = TrackingResultNames();
  for (const auto& name : OdometryResultNames()) results.push_back(name);
  for (const auto& name : EvaluationResultNames(alignments)) results.push_back(name);
  results.emplace_back("manifest.json");
  CheckOutputFolder(arguments.stage.out, results, arguments.common.force);
  const InterruptGuard guard(arguments.stage.out);
  ThreadPool pool(arguments.common.threads);
  const StageContext context{config, &pool, &record, arguments.stage, !arguments.common.quiet};

  const TrackingOutcome tracking = RunTrackingStage(context, &recording);
  std::cout << FormatTracking(tracking) << std::flush;
  const OdometryResult odometry = RunOdometryStage(context, tracking.result.tracks, recording.camera);
  std::cout << FormatOdometry(odometry) << FormatSpeed(tracking.result, record.manifest, pool.size()) << std::flush;
  if (truth) Judge(context, *truth, odometry.trajectory, tracking.result.frames, alignments, arguments.align.empty());
  WriteManifest(context.options.out / "manifest.json", record.manifest);
  std::cout << "results    " << context.options.out.string() << '\n';
}

}  // namespace

Command AddRunCommand(CLI::App& app) {
  auto arguments = std::make_shared<RunArguments>();
  auto* const parser = app.add_subcommand("run", "All stages: events to tracks, trajectory and error report");
  AddRecordingOptions(*parser, arguments->recording);
  parser
      ->add_option("--ground-truth", arguments->ground_truth,
                   "MVSEC _gt.hdf5, UZH groundtruth.txt or TUM text; default: the one in the sequence's folder, if any")
      ->type_name("FILE");
  AddAlignmentOption(*parser, arguments->align);
  AddStageOptions(*parser, arguments->stage);
  AddDrawingOption(*parser, arguments->stage);
  AddConfigurationOptions(*parser, arguments->common);
  AddComputeOptions(*parser, arguments->common);
  AddGroundTruthSourceOption(*parser, arguments->common);
  parser->footer(
      "Example:\n  evo-run run --events outdoor_day2_data.hdf5 --calibration camchain-imucam-outdoor_day.yaml "
      "--ground-truth outdoor_day2_gt.hdf5 --from 12 --to 72 --out out/day2");
  return {parser, [arguments](const auto& command_line) { RunAll(*arguments, command_line); }};
}

}  // namespace evo::app
