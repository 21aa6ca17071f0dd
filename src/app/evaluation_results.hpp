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
/// summary.json, metrics.csv, tables/errors.tex, errors.csv for the first alignment and errors_NAME.csv for each
/// further one ("first:5" becomes first-5).
std::vector<std::string> EvaluationResultNames(std::span<const evaluation::Alignment> alignments);

/// Removes those files, whatever the alignments were, and the plots from `folder`, and manifest.json, which tells of
/// them.
void RemoveEvaluationResults(const std::filesystem::path& folder);

/// Stamps, as written in the estimate, at which the odometry started anew; empty if that is not known.
using Restarts = std::optional<std::vector<TimeNs>>;

/// Logs what the evaluation lacks, writes the files unless it lacks every alignment and, if wanted, the plots
/// trajectory, axes, errors, errors_distance and scale_drift (_NAME) as SVG and PDF.
void WriteEvaluationResults(const std::filesystem::path& folder, const std::string& sequence,
                            const evaluation::Evaluation& evaluation, bool with_plots,
                            const Restarts& restarts = std::nullopt);

/// A name for the sequence that a file of events or ground truth belongs to: "drive" for drive_data.hdf5 and
/// drive_gt.hdf5, the folder's name for events.txt and groundtruth.txt.
std::string SequenceName(const std::filesystem::path& file);

}  // namespace evo::app
