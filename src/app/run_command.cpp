#include <iostream>
#include <memory>

#include "app/commands.hpp"
#include "app/error_place.hpp"
#include "app/evaluation_results.hpp"
#include "app/stages.hpp"
#include "evo/core/error.hpp"
#include "evo/report/terminal_summary.hpp"

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

struct GroundTruth {
  std::filesystem::path path;
  geometry::Trajectory trajectory;
};

std::optional<GroundTruth> OpenGroundTruth(const RunArguments& arguments, const Recording& recording,
                                           RunRecord* record) {
  std::filesystem::path path = arguments.ground_truth;
  if (path.empty() && recording.ground_truth) path = *recording.ground_truth;
  if (path.empty()) return std::nullopt;
  geometry::Trajectory trajectory = io::ReadGroundTruth(path, arguments.common.Source());
  record->AddInput("ground_truth", path);
  return GroundTruth{path, std::move(trajectory)};
}

/// Reports the ground truth of another recording before the work, not after it. `offset` is added to the events' clock.
void RequireOverlap(const GroundTruth& truth, const Recording& recording, TimeNs offset) {
  const auto& interval = recording.interval;
  const TimeNs first = recording.reader->first_stamp();
  const TimeNs from = first + interval.from + offset;
  const TimeNs to = (interval.to ? first + *interval.to : recording.reader->last_stamp()) + offset;
  const TimeNs begin = truth.trajectory.front().t;
  const TimeNs end = truth.trajectory.back().t;
  if (begin <= to && end >= from) return;
  throw Error(ErrorKind::kNothingToDo, truth.path.string() + ": its poses from " + FormatTime(begin) + " s to " +
                                           FormatTime(end) + " s do not overlap the events from " + FormatTime(from) +
                                           " s to " + FormatTime(to) + " s; give the ground truth of this recording");
}

std::vector<std::string> ResultNames(const std::vector<evaluation::Alignment>& alignments) {
  auto results = TrackingResultNames();
  for (const auto& name : OdometryResultNames()) results.push_back(name);
  for (const auto& name : EvaluationResultNames(alignments)) results.push_back(name);
  return results;
}

/// `only_determined`: as far as the motion allows. Prints the summary.
void RunEvaluationStage(StageContext* context, const GroundTruth& truth, const geometry::Trajectory& estimate,
                        const std::vector<geometry::StampedCovariance>& covariances, const std::vector<TimeNs>& frames,
                        const std::vector<evaluation::Alignment>& alignments, bool only_determined) {
  evaluation::EvaluationOptions options = context->config.evaluation;
  options.skip_degenerate_alignments = only_determined;
  const TimeNs offset = FromSeconds(options.association.estimate_clock_offset_s);
  // The truth of the whole interval counts: an estimate that covers a part of it must not look complete.
  const evaluation::EvaluationInterval interval{frames.front() + offset, frames.back() + offset};
  NamingPlace((context->options.out / "trajectory.txt").string() + " against " + truth.path.string(), [&] {
    const evaluation::Evaluation evaluation = context->record.Time("evaluate", [&] {
      return evaluation::Evaluate(truth.trajectory, estimate, alignments, interval, options, covariances);
    });
    context->record.Time("write_evaluation", [&] {
      WriteEvaluationResults(context->options.out, SequenceName(truth.path), evaluation, !context->options.no_plots,
                             context->record.manifest.rebootstraps);
    });
    if (!evaluation.alignments.empty()) std::cout << report::FormatSummary(evaluation);
  });
}

void RunAll(const RunArguments& arguments, const std::vector<std::string>& command_line) {
  const auto alignments = evaluation::ParseAlignments(arguments.align.empty() ? kUsualAlignments : arguments.align);
  StageContext context(arguments.common, arguments.stage, ResultNames(alignments), command_line);
  const std::filesystem::path& out = context.options.out;
  // Every input is opened before any work, so that a wrong one is reported at once.
  Recording recording = OpenRecording(arguments.recording, &context.record);
  const auto truth = OpenGroundTruth(arguments, recording, &context.record);
  if (truth) {
    RequireOverlap(*truth, recording, FromSeconds(context.config.evaluation.association.estimate_clock_offset_s));
  }
  // At once, so that nothing of an earlier run is taken for this one's, which may fail or have no ground truth.
  if (context.force) {
    RemoveTrackingResults(out);
    RemoveOdometryResults(out);
    RemoveEvaluationResults(out);
  }

  events::Tracks tracks;
  const TrackingOutcome tracking = RunTrackingStage(&context, &recording, &tracks);
  std::cout << FormatTracking(tracking) << std::flush;
  const odometry::OdometryResult odometry = RunOdometryStage(&context, tracks, out / "tracks.txt", recording.camera);
  std::cout << FormatOdometry(odometry) << FormatSpeed(context.record.manifest, context.pool.size()) << std::flush;
  if (truth) {
    RunEvaluationStage(&context, *truth, odometry.trajectory, odometry.covariances, tracking.result.frames, alignments,
                       arguments.align.empty());
  }
  context.Finish();
  std::cout << "results    " << out.string() << '\n';
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
  parser->get_option("--align")->default_str(kUsualAlignments);  // as far as the motion determines them
  AddStageOptions(*parser, arguments->stage);
  AddDrawingOptions(*parser, arguments->stage);
  AddConfigurationOptions(*parser, arguments->common);
  AddComputeOptions(*parser, arguments->common);
  AddGroundTruthSourceOption(*parser, arguments->common);
  parser->footer(
      "Example:\n  evo-run run --events outdoor_day2_data.hdf5 --calibration camchain-imucam-outdoor_day.yaml "
      "--ground-truth outdoor_day2_gt.hdf5 --from 12 --to 72 --out out/day2");
  return {parser, [arguments](const auto& command_line) { RunAll(*arguments, command_line); }};
}

}  // namespace evo::app
