#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "evo/evaluation/evaluation.hpp"

namespace evo::app {

/// The files that WriteEvaluationResults makes, relative to the output folder, plots left out: summary.csv,
/// summary.json, tables/errors.tex, errors.csv for the first alignment and errors_NAME.csv for each further one
/// ("first:5" becomes first-5).
std::vector<std::string> EvaluationResultNames(std::span<const Alignment> alignments);

/// Writes them and, if wanted, the plots trajectory, axes, errors and errors_distance (_NAME) as SVG and PDF.
/// `restarts` as in the figures.
void WriteEvaluationResults(const std::filesystem::path& folder, const std::string& sequence,
                            const Evaluation& evaluation, std::span<const TimeNs> restarts, bool with_plots);

/// A name for the sequence that a file of events or ground truth belongs to: "drive" for drive_data.hdf5 and
/// drive_gt.hdf5, the folder's name for events.txt and groundtruth.txt.
std::string SequenceName(const std::filesystem::path& file);

}  // namespace evo::app
