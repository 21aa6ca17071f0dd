#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/recording.hpp"
#include "app/run/stage_run.hpp"
#include "evo/evaluation/evaluation.hpp"
#include "evo/geometry/trajectory.hpp"

namespace evo::app {

struct GroundTruth {
  std::filesystem::path file;
  geometry::Trajectory trajectory;
};

/// Reads the ground truth from `file` or, if that is empty, from the one beside the events; empty if there is none.
/// Throws Error.
std::optional<GroundTruth> OpenGroundTruth(const std::string& file, io::GroundTruthSource source,
                                           const Recording& recording, RunRecord* record);

/// Throws Error (kNothingToDo) if no pose of the truth lies in the interval of the recording, so that the ground truth
/// of another recording is noticed before the work. `clock_offset` is added to the stamps of the events.
void RequireOverlap(const GroundTruth& truth, const Recording& recording, TimeNs clock_offset);

/// The output of the odometry stage to compare with the truth.
struct EstimateInput {
  const geometry::Trajectory& trajectory;
  const std::vector<geometry::StampedCovariance>& covariances;
  const std::vector<TimeNs>& frames;  ///< all event frames: a trajectory that covers a part of them is incomplete
};

/// Evaluates the estimate, writes the results and prints the summary. Throws Error.
void RunEvaluationStage(const evaluation::EvaluationOptions& options, const GroundTruth& truth,
                        const EstimateInput& estimate, const std::vector<evaluation::Alignment>& alignments,
                        StageRun* run);

}  // namespace evo::app
