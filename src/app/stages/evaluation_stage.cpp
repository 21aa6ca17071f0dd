#include "app/stages/evaluation_stage.hpp"

#include <fmt/format.h>

#include <iostream>
#include <utility>

#include "app/evaluation/trajectory_results.hpp"
#include "app/run/error_context.hpp"
#include "app/stages/diagnosis.hpp"
#include "evo/core/error.hpp"
#include "evo/io/trajectory_io.hpp"
#include "evo/report/terminal_summary.hpp"

namespace evo::app {

std::optional<GroundTruth> OpenGroundTruth(const std::string& file, io::GroundTruthSource source,
                                           const Recording& recording, RunRecord* record) {
  std::filesystem::path path = file;
  if (path.empty() && recording.ground_truth) path = *recording.ground_truth;
  if (path.empty()) return std::nullopt;
  geometry::Trajectory trajectory = io::ReadGroundTruth(path, source);
  record->AddInput("ground_truth", path);
  return GroundTruth{path, std::move(trajectory)};
}

void RequireOverlap(const GroundTruth& truth, const Recording& recording, TimeNs clock_offset) {
  const auto& interval = recording.interval;
  const TimeNs first = recording.reader->first_stamp();
  const TimeNs from = first + interval.from + clock_offset;
  const TimeNs to = (interval.to ? first + *interval.to : recording.reader->last_stamp()) + clock_offset;
  const TimeNs begin = truth.trajectory.front().t;
  const TimeNs end = truth.trajectory.back().t;
  if (begin <= to && end >= from) return;
  throw Error(
      ErrorKind::kNothingToDo,
      fmt::format("{}: its poses from {} s to {} s do not overlap the events from {} s to {} s; give the ground "
                  "truth of this recording",
                  truth.file.string(), FormatTime(begin), FormatTime(end), FormatTime(from), FormatTime(to)));
}

void RunEvaluationStage(const evaluation::EvaluationOptions& options, const GroundTruth& truth,
                        const EstimateInput& estimate, const std::vector<evaluation::Alignment>& alignments,
                        StageRun* run) {
  const std::filesystem::path& out = run->results.out;
  const TimeNs offset = FromSeconds(options.association.estimate_clock_offset_s);
  const evaluation::EvaluationInterval interval{estimate.frames.front() + offset, estimate.frames.back() + offset};
  WithErrorDiagnosis(run->diagnosis, [&] {
    WithErrorContext((out / "trajectory.txt").string() + " against " + truth.file.string(), [&] {
      const evaluation::Evaluation evaluation = run->record.Time("evaluate", [&] {
        return evaluation::Evaluate(truth.trajectory, estimate.trajectory, alignments, interval, options,
                                    estimate.covariances);
      });
      run->record.Time("write_evaluation", [&] {
        WriteEvaluationResults(out, SequenceName(truth.file), evaluation, !run->results.no_plots,
                               run->record.manifest.rebootstraps);
      });
      if (!evaluation.alignments.empty()) std::cout << report::FormatSummary(evaluation);
    });
  });
}

}  // namespace evo::app
