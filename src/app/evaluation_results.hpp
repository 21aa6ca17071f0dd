#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "evo/evaluation/evaluation.hpp"

namespace evo::app {

/// The files that WriteEvaluationResults makes, relative to the output folder, plots left out: summary.csv,
/// summary.json, metrics.csv, errors.csv for the first alignment and errors_NAME.csv for each further one ("first:5"
/// becomes first-5).
std::vector<std::string> EvaluationResultNames(std::span<const Alignment> alignments);

/// Logs what the evaluation lacks, writes the files unless it lacks every alignment and, if wanted, plots/trajectory
/// and plots/errors (_NAME) as SVG and PDF.
void WriteEvaluationResults(const std::filesystem::path& folder, const std::string& sequence,
                            const Evaluation& evaluation, bool with_plots,
                            std::optional<std::int64_t> rebootstraps = std::nullopt);

/// A name for the sequence that a ground truth file belongs to: "drive" for drive_gt.hdf5, the folder's name for
/// groundtruth.txt.
std::string SequenceName(const std::filesystem::path& ground_truth);

}  // namespace evo::app
